#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "path/path_tracker.h"

#include <optional>
#include <string>
#include <vector>

/// Functions of LiveFlight at one moment: phase, battery, start in the air.
namespace flightwatt::live {

/// Sets phase and times from the last sortie. A climb that has not held its height yet is a take-off. Landed: the
/// height has been constant since the touchdown for a rest (no touch-and-go), or the telemetry is over (`is_over`).
void update_flight_times(const flight::Sortie& sortie, const flight::Track& altitude_m, double now_s, bool is_over,
                         LiveState& state);

/// Time before which rows are not needed: in the air five minutes before the lift-off, on the ground ten minutes ago
/// (earlier for a sortie that reaches into them).
double retention_start_s(const flight::FlightPhases& phases, const LiveState& state);

/// An error's text without "FLIGHT: " before it.
std::string without_flight_name(const std::string& text, const std::string& flight);

/// Progress of a flight whose telemetry begins in the air, since its first message. Throws NoResultError before 30 s of
/// cruise were received.
mechanical::FlightProgress airborne_progress(const flight::FlightData& data, const flight::Sortie& sortie);

/// Predicts a flight whose telemetry begins in the air. Unless the start of the cruise was received or the remaining
/// time is given, that is uniform between 0 and the mission's cruise less the part received. Throws as predict_energy.
Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix, Remarks& remarks);

/// Sets the state of charge by the autopilot's counter, which counts from `initial_soc_percent` on, where it is not
/// known otherwise.
void estimate_soc_from_counter(const flight::Track& charge_ah, double capacity_ah, double initial_soc_percent,
                               LiveBattery& result);

/// The alarms of a state, most severe first: silent link, probability of missing the reserve, voltage below the
/// battery's model, power outside the model's 95 % interval. `before`: of the last state. A grade that was reached ends
/// at half of its threshold, so that an alarm near it does not come and go.
std::vector<LiveAlarm> find_alarms(const LiveState& state, const std::optional<PredictionInput>& input,
                                   const std::vector<LiveAlarm>& before);

}  // namespace flightwatt::live
