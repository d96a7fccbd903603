#pragma once

#include "battery/discharge_record.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

/// The charge by the voltage, and whether it contradicts the charge counted.
namespace flightwatt::live {

/// Time before the end of the data whose voltages are compared [s], and the samples that are needed in it.
inline constexpr double watched_s = 60.0;
inline constexpr std::size_t enough_samples = 5;

/// The voltage below the battery's model [V] that contradicts the charge drawn: a cell at 3.7 V would be at 3.4 V.
inline constexpr double failing_cell_v = 0.3;

/// Returns how far the voltage is below the battery's model where it contradicts the charge [V]: more than another
/// resistance explains.
inline double contradicting_v(double explained_v) { return std::max(failing_cell_v, explained_v); }

/// What the voltage of the last minute shows.
struct VoltageCheck {
    double residual_v = 0.0;   ///< measured less the battery's model, median
    double explained_v = 0.0;  ///< with the median current, what the resistance of 95 in 100 flights differs by
    double soc_percent = 0.0;  ///< state of charge by the voltage
    double sd_percent = 0.0;   ///< its standard deviation [points]
};

/// Compares the voltage at the end of a record with the battery's model; std::nullopt with too few samples, or for a
/// battery of constant voltage.
std::optional<VoltageCheck> check_voltage(const battery::Battery& battery, const battery::DischargeRecord& record,
                                          double initial_soc_percent);

/// Returns the warning that a prediction begins with the charge by the voltage, as more was counted.
std::string voltage_warning(double counted_percent, double by_voltage_percent);

/// Returns the state of charge [%] at a time of a record; std::nullopt before its start.
std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s);

}  // namespace flightwatt::live
