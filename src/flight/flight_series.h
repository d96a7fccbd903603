#pragma once

#include "telemetry/log_notes.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A quantity over time on its own clock, from one field of the log. `time_s` rises strictly; `value` has the same size
/// and is finite. A value depends on nothing that the log has of a later time.
struct Track {
    std::string name = {};    ///< with the unit as suffix: "power_w"
    std::string source = {};  ///< "ENERGY.power"
    std::string device = {};  ///< id, if several devices report the quantity; usually empty
    double since_s = -std::numeric_limits<double>::infinity();  ///< time of the field's first message
    std::vector<double> time_s = {};                            ///< the log's own seconds
    std::vector<double> value = {};

    bool empty() const { return time_s.empty(); }
    bool operator==(const Track&) const = default;
};

/// The source of a track of a CSV without front matter.
inline constexpr auto plain_source = "series CSV";

/// How several values at the same time become one.
enum class Merge {
    mean,   ///< their mean: for measurements
    latest  ///< the last one in the log: for counters and states
};

/// Returns a track without a name from times and values of equal number: drops values that are not finite, sorts by
/// time, merges equal times.
Track make_track(const std::vector<double>& time_s, const std::vector<double>& values, Merge merge);

/// Removes the samples i with is_out(i). Returns their number.
template <typename IsOut>
std::size_t erase_samples(Track& track, const IsOut& is_out) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < track.time_s.size(); ++i) {
        if (is_out(i)) continue;
        track.time_s[kept] = track.time_s[i];
        track.value[kept++] = track.value[i];
    }
    const auto erased = track.time_s.size() - kept;
    track.time_s.resize(kept);
    track.value.resize(kept);
    return erased;
}

/// Returns the value of a track at a time: linear between its points, the first or last value outside. The track must
/// not be empty.
double value_at(const Track& track, double time_s);

/// Returns the last value at or before `time_s` (before the track begins, the first). The track must not be empty.
double state_at(const Track& track, double time_s);

/// Returns value_at() for every time, in one pass: `time_s` must rise. Empty for an empty track.
std::vector<double> resample(const Track& track, const std::vector<double>& time_s);

/// Returns the integral of values over time between two times, linear between samples [unit of the values * s].
double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s, double end_s);

/// Returns the interval without a sample above which it is a gap: three times the median interval, at most 10 s [s].
double gap_threshold_s(const std::vector<double>& time_s);

/// Returns the median interval of samples [s].
double median_interval_s(const std::vector<double>& time_s);

/// Returns the index of the first of rising times that is not before `from_s`; their number without one.
std::size_t first_at_or_after(const std::vector<double>& time_s, double from_s);

/// Returns the index of the first of rising times that is after `until_s`; their number without one.
std::size_t first_after(const std::vector<double>& time_s, double until_s);

/// Returns whether all values are equal; true for an empty track.
bool is_constant(const Track& track);

/// What carries a VTOL aircraft, by the numbers of MAVLink's MAV_VTOL_STATE: the track "vtol_state".
enum class VtolState { transition_to_wing = 1, transition_to_hover = 2, hover = 3, wing = 4 };

using telemetry::CurrentOrigin;

/// A restart of the log's clock: another recording follows, or overlaps the first.
struct ClockRestart {
    double visible_from_s = 0.0;  ///< a log that ends before this time shows no restart
    double from_s = 0.0;
    double to_s = 0.0;
    std::string message;
    bool operator==(const ClockRestart&) const = default;
};

/// Kinds of battery monitors that measure no pack of their own: the sum of others, or of the ESCs; the pins of an
/// earlier one; fuel; and a current that is computed from the throttle. And smart batteries with serial numbers of their own.
inline constexpr auto sum_monitor = "sum";
inline constexpr auto escs_monitor = "ESCs";
inline constexpr auto same_pins_monitor = "same pins";
inline constexpr auto fuel_monitor = "fuel";
inline constexpr auto throttle_monitor = "throttle";
inline constexpr auto smart_pack_monitor = "smart pack";

/// What a log states of a flight apart from its tracks.
struct FlightInfo {
    std::string file;           ///< path of the file, for errors
    std::string flight;         ///< the log's name without folder and ending
    std::string aircraft_id;    ///< as in the log; empty if unknown (a plain CSV)
    std::string aircraft_name;  ///< from the .log; may be empty
    std::string firmware;       ///< from the .log: "fixedwing", "rotorcraft", "rover"; may be empty

    // Known before the flight, from the .log.
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::optional<double> planned_ground_altitude_m;
    std::optional<double> start_clock_s;     ///< Unix time of the log's second 0
    std::map<int, std::string> block_names;  ///< names of the values of the track "block"
    /// Kinds of battery monitors by the log's parameters, by id, if they are of these above.
    std::map<std::string, std::string> monitor_kinds;
    /// Capacities of the monitors' packs by the log's parameters (BATT_CAPACITY, BAT1_CAPACITY), by id [Ah].
    std::map<std::string, double> monitor_capacities_ah;
    std::map<std::string, double> monitor_cells;  ///< in series, as the log states them (PX4), by the monitors' ids
    std::string pack_serial;                      ///< of a smart battery, joined by "+" of several; empty if unknown
    std::optional<double> pack_cycles;            ///< charge cycles that it counts; of several the most
    std::optional<double> motors;                 ///< their number by the log's parameters
    bool log_is_missing = false;                  ///< the log has no .log

    std::vector<telemetry::AssumedDefinition> assumed_definitions;
    std::vector<telemetry::SkippedLines> skipped;  ///< in order of the first line
    std::optional<ClockRestart> clock_restart;
    std::vector<std::string> notes;  ///< changes of the series, for the user

    bool operator==(const FlightInfo&) const = default;
};

/// The tracks of one aircraft in one log as logged: several of one name if several messages have the quantity.
/// select_tracks() chooses among them, so that a truncated series equals the series of a log that ends there.
struct FlightSeries : FlightInfo {
    std::vector<Track> tracks;  ///< in the order of track_names(); of equal names the preferred one first

    bool operator==(const FlightSeries&) const = default;
};

/// Returns the last time at which any source of power or altitude was logged; -infinity without any.
double last_time_s(const FlightSeries& series);

/// Replaces all tracks of the name of `track` by it.
void replace_track(FlightSeries& series, Track track);

/// Returns the series that the same log would have if it ended at `until_s` (the log's own seconds).
FlightSeries truncate_series(FlightSeries series, double until_s);

}  // namespace flightwatt::flight
