#pragma once

#include "battery/discharge_record.h"
#include "flight/flight_data.h"
#include "live/live_state.h"
#include "live/prediction.h"

#include <optional>
#include <string>

/// The state of charge of a flight in progress.
namespace flightwatt::live {

/// Estimates the state of charge at the end of the data by the charge drawn and by voltage; without a usable record (at
/// rest, or started in flight) by voltage alone. `carried` is the known state of charge at the start of the data. Sets
/// `record` to the record used.
LiveBattery estimate_soc(const PredictionInput& input, const std::optional<InitialCharge>& carried,
                         const flight::FlightData& data, std::optional<battery::DischargeRecord>& record);

/// The voltage below the battery's model [V] that contradicts the charge drawn: a cell at 3.7 V would be at 3.4 V.
inline constexpr double failing_cell_v = 0.3;

/// What the voltage of the last minute shows.
struct VoltageCheck {
    double residual_v = 0.0;   ///< measured less the battery's model, median
    double soc_percent = 0.0;  ///< state of charge by the voltage
    double sd_percent = 0.0;   ///< its standard deviation [points]
};

/// Compares the voltage at the end of a record with the battery's model; std::nullopt with too few samples, or for a
/// battery of constant voltage.
std::optional<VoltageCheck> check_voltage(const battery::Battery& battery, const battery::DischargeRecord& record,
                                          double initial_soc_percent);

/// Returns the warning that a prediction begins with the charge by the voltage, as more was counted.
std::string voltage_warning(double counted_percent, double by_voltage_percent);

/// Sets the state for forecasts by the voltage, if this shows less charge than was counted.
void use_voltage_if_lower(LiveBattery& now);

/// Returns the battery as forecasts begin with it. `now` has a state.
BatteryNow battery_now(const LiveBattery& now);

/// Returns the state of charge [%] at a time of a record; std::nullopt before its start.
std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s);

/// Returns the probability of landing below the reserve or not at all, by a first-order reliability method from the
/// predictive distributions of the energy (Student's t), of the capacity and of the initial charge (normal, if
/// uncertain; docs/methods.md); std::nullopt without a known uncertainty. `now` has a state.
std::optional<double> probability_below_reserve(const PredictionInput& input, const Prediction& prediction,
                                                const LiveBattery& now);

}  // namespace flightwatt::live
