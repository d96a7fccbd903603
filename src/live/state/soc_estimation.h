#pragma once

#include "battery/discharge_record.h"
#include "flight/flight_data.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "live/state/voltage_check.h"

#include <optional>

/// The state of charge of a flight in progress.
namespace flightwatt::live {

/// Estimates the state of charge at the end of the data by the charge drawn and by voltage; without a usable record (at
/// rest, or started in flight) by voltage alone. `carried` is the known state of charge at the start of the data. Sets
/// `record` to the record used.
LiveBattery estimate_soc(const PredictionInput& input, const std::optional<InitialCharge>& carried,
                         const flight::FlightData& data, std::optional<battery::DischargeRecord>& record);

/// Sets the state for forecasts by the voltage, if this shows less charge than was counted.
void use_voltage_if_lower(LiveBattery& now);

/// Returns the battery as forecasts begin with it. `now` has a state.
BatteryNow battery_now(const LiveBattery& now);

/// Returns the probability of landing below the reserve or not at all, by a first-order reliability method from the
/// predictive distributions of the energy (Student's t), of the capacity and of the initial charge (normal, if
/// uncertain; docs/methods.md); std::nullopt without a known uncertainty. `now` has a state.
std::optional<double> probability_below_reserve(const PredictionInput& input, const Prediction& prediction,
                                                const LiveBattery& now);

}  // namespace flightwatt::live
