#pragma once

#include "battery/battery.h"
#include "battery/identification/circuit_fit.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// The open-circuit voltage that lithium-polymer packs are commonly said to have, a cell: 4.20 V full, 3.84 V half,
/// 3.27 V empty (the voltage chart that sellers of packs print, e.g. blog.ampow.com/lipo-voltage-chart). Packs differ
/// from it by some 30 mV; it stands in only for what no flight has shown.
inline constexpr double lipo_chart_uncertainty_v = 0.03;

/// [V] a cell at a state of charge, 0 to 100.
double lipo_chart_voltage_v(double soc_percent);

/// The inverse; 0 below and 100 above the chart.
double lipo_chart_soc_percent(double cell_voltage_v);

/// How many cells a pack has that rests at this voltage, if it is charged: at most 4.25 V a cell.
int lipo_cells(double resting_voltage_v);

/// Where a capacity comes from.
enum class CapacityOrigin {
    given,  ///< by the user
    flown,  ///< a flight drew all of it
    chart   ///< from the part of the LiPo chart that the open-circuit voltage went down
};

std::string to_string(CapacityOrigin origin);

struct Capacity {
    double value_ah = 0.0;
    CapacityOrigin origin = CapacityOrigin::given;
    /// 95 %, of a chart's: normal errors of the voltage at the end and of the chart, 30 mV a cell (1 sd).
    std::optional<Interval> interval_ah;
};

/// The capacity of a battery whose open-circuit voltage was followed from full down; `last_error_v` is the standard
/// error of the voltage at the last knot. Throws UsageError if the given one
/// is less than a flight drew, and NoAnswerError if none is given and the flights hardly drew anything.
Capacity capacity_of(const CircuitFit& fit, double last_error_v, int cells, std::optional<double> given_ah);

/// The fitted curve over state of charge, full at its first knot; below its last one it goes on in parallel
/// to the LiPo chart of that many cells.
struct ExtendedCurve {
    OpenCircuitVoltage curve;
    std::vector<double> standard_error_v;  ///< 30 mV a cell more where the chart stands in
    double known_down_to_percent = 0.0;
};

ExtendedCurve extended_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, double capacity_ah,
                             int cells);

}  // namespace flightwatt::battery
