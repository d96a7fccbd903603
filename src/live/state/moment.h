#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "path/path_tracker.h"

#include <optional>
#include <string>
#include <vector>

/// Parts of the state of LiveFlight at one moment: phase, battery, alarms, start in the air.
namespace flightwatt::live {

/// Returns whether the autopilot states now that it is in the air, and not that it is disarmed.
bool states_flight(const flight::FlightData& data);

/// Sets phase and times from the last sortie. A climb that has not held its height yet is a take-off. The aircraft has
/// landed if its height has been constant since the touchdown for the time of a rest (no touch-and-go) and the
/// autopilot does not state that it flies, or if the telemetry has ended (`is_over`).
void update_flight_times(const flight::Sortie& sortie, const flight::FlightData& data, bool is_over, LiveState& state);

/// Returns the time since the last power, in the air and where it is at least that of a silent link; else 0.
double time_without_power_s(const flight::Track& power_w, const LiveState& state);

/// Returns the time before which rows are not needed: in the air five minutes before the lift-off, on the ground ten
/// minutes ago (earlier for a sortie that extends into them).
double retention_start_s(const flight::FlightPhases& phases, const LiveState& state);

/// Returns an error's text without "FLIGHT: " before it.
std::string without_flight_name(const std::string& text, const std::string& flight);

/// Returns the progress, since its first message, of a flight whose telemetry begins in the air. Throws NoResultError
/// before 30 s of cruise were received.
mechanical::FlightProgress airborne_progress(const flight::FlightData& data, const flight::Sortie& sortie);

/// Predicts a flight whose telemetry begins in the air. Unless the start of the cruise was received or the remaining
/// time is given, the remaining time is uniformly distributed between 0 and the mission's cruise less the part
/// received. Throws as predict_energy.
Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix, Remarks& remarks);

/// Sets the state of charge, if it is not known otherwise, by the autopilot's counter of charge, which began at
/// `initial_soc_percent`.
void estimate_soc_from_counter(const flight::Track& charge_ah, double capacity_ah, double initial_soc_percent,
                               LiveBattery& result);

/// Returns the alarms of a state, most severe first: silent link or power, probability of missing the reserve, voltage below the
/// battery's model, power outside the model's 95 % interval. `before` are those of the last state: a grade ends at half
/// of its threshold, so that an alarm near it does not come and go.
std::vector<LiveAlarm> find_alarms(const LiveState& state, const std::optional<PredictionInput>& input,
                                   const std::vector<LiveAlarm>& before);

}  // namespace flightwatt::live
