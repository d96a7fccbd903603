#pragma once

#include "battery/discharge_record.h"
#include "flight/flight_data.h"
#include "live/live_state.h"
#include "live/prediction.h"

#include <optional>

/// The state of charge of a flight in progress.
namespace flightwatt::live {

/// The state of charge by the charge drawn and by voltage, of a series that ends now. `carried_percent`: known state of
/// charge at its start. Without a usable record (at rest, or started in flight) only by voltage.
LiveBattery estimate_soc(const PredictionInput& input, const std::optional<double>& carried_percent,
                         const flight::FlightData& data, std::optional<battery::DischargeRecord>& record);

std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s);

/// Probability of landing below the reserve or not at all, from the predictive distributions of the energy (Student's
/// t) and the capacity (normal, where it has an interval) by a first-order reliability method (docs/live.md). `now` has
/// a state.
std::optional<double> probability_below_reserve(const PredictionInput& input, const Prediction& prediction,
                                                const LiveBattery& now);

}  // namespace flightwatt::live
