#pragma once

#include "battery/battery.h"
#include "battery/identification/chart_match.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// How many cells a pack has that rests at this voltage, if it is charged: at most 4.25 V a cell.
int lipo_cells(double resting_voltage_v);

/// No lithium cell rests below or above these.
inline constexpr double min_cell_voltage_v = 2.5;
inline constexpr double max_cell_voltage_v = 4.5;

/// Throws UsageError where a pack of so many cells cannot rest at this voltage.
void require_possible_cells(double resting_voltage_v, int cells);

/// The capacity as the posterior of capacity_posterior has it: its median and quantiles. It is `measured` where the
/// flights leave at most 5 % of it. Throws UsageError if the given one is less than what was drawn from the pack, and
/// NoResultError if none is given and the flights drew too little: less than 3 % of the median.
Capacity estimate_capacity(double drawn_ah, std::span<const CapacityHypothesis> posterior,
                           std::optional<double> given_ah);

/// The fitted curve over state of charge; beyond its ends it goes on in parallel to the chart of that many cells.
struct ExtendedCurve {
    OpenCircuitVoltage curve;
    std::vector<double> standard_error_v;  ///< more where the chart stands in: extrapolation_sd_v
    double known_down_to_percent = 0.0;
    double known_up_to_percent = 0.0;
};

/// `missing_ah` is what was missing from the full pack where the curve begins.
ExtendedCurve extrapolate_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, Chemistry chemistry,
                                double capacity_ah, double missing_ah);

}  // namespace flightwatt::battery
