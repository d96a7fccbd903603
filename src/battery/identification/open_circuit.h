#pragma once

#include "battery/battery.h"
#include "battery/identification/chart_match.h"
#include "battery/identification/circuit_fit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// The open-circuit voltage that lithium-polymer packs are commonly said to have, a cell: 4.20 V full, 3.84 V half,
/// 3.27 V empty (the voltage chart that sellers of packs print, e.g. blog.ampow.com/lipo-voltage-chart). Packs differ
/// from it by some 80 mV (chart_match.h); it stands in only for what no flight has shown.

/// [V] a cell at a state of charge, 0 to 100.
double lipo_chart_voltage_v(double soc_percent);

/// How many cells a pack has that rests at this voltage, if it is charged: at most 4.25 V a cell.
int lipo_cells(double resting_voltage_v);

/// No lithium cell rests below or above these.
inline constexpr double min_cell_voltage_v = 2.5;
inline constexpr double max_cell_voltage_v = 4.5;

/// Throws UsageError where a pack of so many cells cannot rest at this voltage.
void require_possible_cells(double resting_voltage_v, int cells);

/// What is doubtful of the number of cells, by the voltage of the fullest pack at rest: a cell below or above the LiPo
/// chart; or, where the number was not given, full high-voltage cells (up to 4.45 V), one less. Empty if nothing is.
std::string cells_warning(double resting_voltage_v, int cells, bool is_given);

/// Where a capacity comes from.
enum class CapacityOrigin {
    given,     ///< by the user
    measured,  ///< the flights drew nearly all of it
    chart      ///< from the part of the LiPo chart that the open-circuit voltage went down
};

std::string to_string(CapacityOrigin origin);

struct Capacity {
    double value_ah = 0.0;
    CapacityOrigin origin = CapacityOrigin::given;
    std::optional<Interval> interval_ah;  ///< 95 %; none of one that is given
};

/// The capacity as the posterior of capacity_posterior has it: its median and quantiles. It is `measured` where the
/// flights leave at most 5 % of it. Throws UsageError if the given one is less than what was drawn from the pack, and
/// NoResultError if none is given and the flights drew too little: less than 3 % of the median.
Capacity estimate_capacity(double drawn_ah, std::span<const CapacityHypothesis> posterior,
                           std::optional<double> given_ah);

/// The fitted curve over state of charge; beyond its ends it goes on in parallel to the LiPo chart of that many cells.
struct ExtendedCurve {
    OpenCircuitVoltage curve;
    std::vector<double> standard_error_v;  ///< 80 mV a cell more where the chart stands in
    double known_down_to_percent = 0.0;
    double known_up_to_percent = 0.0;
};

/// `missing_ah` is what was missing from the full pack where the curve begins.
ExtendedCurve extrapolate_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, double capacity_ah,
                                double missing_ah);

}  // namespace flightwatt::battery
