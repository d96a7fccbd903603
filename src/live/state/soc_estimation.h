#pragma once

#include "battery/discharge_record.h"
#include "battery/landing_forecast.h"
#include "live/live_flight.h"

#include <optional>

namespace flightwatt::live {

/// The charge that is left, by what was drawn of it and by its voltage, from a series that ends now. `carried_percent`
/// is the state of charge where the series begins, if it is known from what lay before. Where there is no usable record
/// yet (at rest, or from within a flight) the voltage alone tells it.
LiveBattery estimate_soc(const PredictionInput& basis, const std::optional<double>& carried_percent,
                         const flight::SelectedTracks& tracks, std::optional<battery::DischargeRecord>& record);

/// Of a series that begins in the air: where the state of charge at the flight's beginning is given, what the
/// autopilot's counter has left of it.
void estimate_soc_from_counter(const PredictionInput& basis, const flight::FlightSeries& series, LiveBattery& result);

/// The state of charge at a time of the record.
std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s);

/// The probability, after the predictive distributions of the energy (Student's t) and of the capacity (normal, by its
/// interval, where the battery has one), of landing with less than the reserve or not at all (docs/methods.md). `now`
/// has a state.
std::optional<double> probability_below_reserve(const PredictionInput& basis, const Prediction& prediction,
                                                const LiveBattery& now);

}  // namespace flightwatt::live
