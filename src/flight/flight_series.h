#pragma once

#include "telemetry/log_notes.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A quantity on its own clock, from one field of the log. `time_s` rises strictly; `value` has the same size and is
/// finite. A value depends on nothing that the log has of a later time.
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

/// Treatment of several values at the same time.
enum class Merge {
    mean,   ///< measurements
    latest  ///< counters and states: the last one in the log
};

/// A track, without a name, from raw rows of equal number: drops values that are not finite, sorts by time, merges
/// equal times.
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

/// Linear between the track's points, its first and last value outside. The track must not be empty.
double value_at(const Track& track, double time_s);

/// The last value at or before `time_s` (before the track begins, the first). The track must not be empty.
double state_at(const Track& track, double time_s);

/// value_at for every time, in one pass: `time_s` must rise. Empty for an empty track.
std::vector<double> resample(const Track& track, const std::vector<double>& time_s);

/// Integral of any channel over time between two times, linear between samples [channel * s].
double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s, double end_s);

/// A longer interval without a sample is a gap: three times the median interval, at most 10 s [s].
double gap_threshold_s(const std::vector<double>& time_s);

/// Median interval of samples [s].
double median_interval_s(const std::vector<double>& time_s);

/// Whether all values are equal, or there are no values.
bool is_constant(const Track& track);

using telemetry::CurrentOrigin;

/// The log's clock restarts: another recording follows, or overlaps the first.
struct ClockRestart {
    double visible_from_s = 0.0;  ///< a log that ends before this time shows no restart
    double from_s = 0.0;
    double to_s = 0.0;
    std::string message;
    bool operator==(const ClockRestart&) const = default;
};

inline constexpr auto sum_monitor = "sum";
inline constexpr auto escs_monitor = "ESCs";

/// What a log states of a flight apart from its tracks.
struct FlightInfo {
    std::string file;           ///< for errors
    std::string flight;         ///< the log's name without folder and ending
    std::string aircraft_id;    ///< as in the log; empty if unknown (a plain CSV)
    std::string aircraft_name;  ///< from the .log; may be empty
    std::string firmware;       ///< from the .log: "fixedwing", "rotorcraft", "rover"; may be empty

    // Known before the flight, from the .log.
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::optional<double> planned_ground_altitude_m;
    std::optional<double> start_clock_s;     ///< Unix time of the log's second 0
    std::map<int, std::string> block_names;  ///< of the track "block"
    /// What battery monitors measure by the log's parameters, by id: sum_monitor or escs_monitor.
    std::map<std::string, std::string> monitor_kinds;
    bool log_is_missing = false;  ///< telemetry without a .log

    std::vector<telemetry::AssumedDefinition> assumed_definitions;
    std::vector<telemetry::SkippedLines> skipped;  ///< by first line
    std::optional<ClockRestart> clock_restart;
    std::vector<std::string> notes;  ///< changes of the series, for the user

    bool operator==(const FlightInfo&) const = default;
};

/// The tracks of one aircraft in one log as logged, several of one name if several messages have the quantity.
/// select_tracks() chooses among them, so that a truncated series equals the series of a log that ends there.
struct FlightSeries : FlightInfo {
    std::vector<Track> tracks;  ///< in the order of track_names(), of one name the best first

    bool operator==(const FlightSeries&) const = default;
};

/// All names of tracks, in the order of the series file's columns.
const std::vector<std::string>& track_names();

/// The last time at which any source of power or altitude was logged; -infinity without any.
double last_time_s(const FlightSeries& series);

/// Replaces all tracks of that name.
void replace_track(FlightSeries& series, Track track);

/// The series of the same log if it ended at `until_s` (the log's own seconds).
FlightSeries truncate_series(FlightSeries series, double until_s);

}  // namespace flightwatt::flight
