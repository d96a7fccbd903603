#pragma once

#include "battery/discharge_record.h"
#include "flight/flight_phases.h"
#include "live/live_flight.h"
#include "path/path_tracker.h"

#include <optional>
#include <string>
#include <vector>

/// What LiveFlight asks at each moment: where the flight is, what its battery holds, how it ends, what is alarming.
namespace flightwatt::live {

/// Phase and times of the last sortie as it looks at `now_s`. A climb that has not held its height yet is a take-off;
/// an aircraft has landed when it keeps its height after the touchdown for as long as a rest takes, as it may touch and
/// go, or when nothing more of it comes (`is_over`).
void update_flight_times(const flight::Sortie& sortie, const flight::Track& altitude_m, double now_s, bool is_over,
                         LiveState& state);

/// What lies before is not needed any more: in a sortie five minutes before its lift-off, on the ground ten minutes ago
/// (but all of a sortie that reaches into them).
double retention_start_s(const flight::FlightPhases& phases, const LiveState& state);

/// An error's text without "FLIGHT: " before it.
std::string without_flight_name(const std::string& text, const std::string& flight);

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

/// The rest of a flight whose telemetry begins in the air, from what was seen of its cruise since. Where its cruise had
/// begun before, and nobody says how much of it is left, that is evenly likely from nothing to all but what was seen:
/// half of it is expected, and the interval holds the rest. The level is the model's mean, moved by what was seen. The
/// battery goes on from its state; `places` finds where on its path it is. Throws NoResultError before 30 s of cruise
/// were seen, and as predict_energy.
Prediction predict_airborne_start(const PredictionInput& basis, const flight::FlightSeries& series,
                                  const flight::Sortie& sortie, const LiveBattery* battery, path::PathTracker* places,
                                  Diagnostics& remarks);

/// What was known of a flight in the air when its clock began anew: the log or the aircraft restarted.
struct CarriedFlight {
    double clock_s = 0.0;  ///< of the clock before
    std::optional<double> energy_wh = {};
    std::optional<double> soc_percent = {};
    std::optional<double> counted_wh = {};  ///< by the autopilot's counters then
    std::optional<double> counted_ah = {};
};

/// From the state of a flight in the air, and the series that it is of.
CarriedFlight carried_flight(const LiveState& state, const flight::SelectedTracks& tracks);

/// Adds what was known before to a state whose series begins in the air. The counters fill the time between: one that
/// goes on by its difference, one that began anew with the aircraft by all it has counted. Without one, energy is
/// unknown, and the charge is that of the voltage. A warning says which. `battery`: none, if there is none.
void continue_flight(const CarriedFlight& before, const flight::SelectedTracks& tracks, double now_s,
                     const std::optional<battery::Battery>& battery, LiveState& state);

/// What somebody should look at now, in words: the reserve in danger (it is not kept at the high end of the energy's
/// interval), power so far outside of the 95 % interval that the model gave it beforehand, a silent link, a voltage
/// below the battery's model.
std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& basis, double silence_s);

}  // namespace flightwatt::live
