#pragma once

#include "battery/battery.h"
#include "battery/identification/chart_match.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// The number of cells of a charged pack at rest: up to 4.25 V each, or 4.38 V where one more had 25 % or less left.
int lipo_cells(double resting_voltage_v);

/// No lithium cell rests below or above these.
inline constexpr double min_cell_voltage_v = 2.5;
inline constexpr double max_cell_voltage_v = 4.5;

/// Whether so many LiPo cells, high-voltage ones too, are neither below empty nor above full at rest.
bool are_possible_lipo_cells(double resting_voltage_v, int cells);

/// Throws UsageError where a pack with this number of cells cannot rest at the voltage of this flight, the fullest.
void require_possible_cells(const std::string& flight, double resting_voltage_v, int cells);

/// The median and quantiles of the posterior, `measured` where the flights leave at most 5 % of it. Throws NoResultError
/// if no capacity is given and the flights drew less than 3 % of the median.
Capacity estimate_capacity(double drawn_ah, std::span<const CapacityHypothesis> posterior,
                           std::optional<double> given_ah);

/// The fitted curve over state of charge; beyond its ends it is extrapolated in parallel to the chart.
struct ExtendedCurve {
    OpenCircuitVoltage curve;
    std::vector<double> standard_error_v;  ///< with extrapolation_sd_v beyond the ends
    double known_down_to_percent = 0.0;
    double known_up_to_percent = 0.0;
};

/// `missing_ah` is the charge missing from the full pack where the curve begins.
ExtendedCurve extrapolate_curve(const CircuitFit& fit, const std::vector<double>& standard_error_v, Chemistry chemistry,
                                double capacity_ah, double missing_ah);

}  // namespace flightwatt::battery
