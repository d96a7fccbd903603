#pragma once

#include "telemetry/log_notes.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::flight {

/// A quantity on its own clock, as one field of the log tells it. `time_s` rises strictly, `value` is as long
/// and finite. A value at t depends on nothing that the log wrote of a later time.
struct Track {
    std::string name = {};    ///< with the unit as suffix: "power_w"
    std::string source = {};  ///< "ENERGY.power"
    std::string device = {};  ///< one of several that report the quantity one at a time; usually empty
    double since_s = -std::numeric_limits<double>::infinity();  ///< when the log first had the field at all
    std::vector<double> time_s = {};                            ///< the log's own seconds
    std::vector<double> value = {};

    bool empty() const { return time_s.empty(); }
    bool operator==(const Track&) const = default;
};

/// A track as it is chosen, and what of the log is not used for it.
struct TrackSelection {
    const Track* logged = nullptr;                   ///< one of the series' own, where it is taken as it stands
    Track derived = {};                              ///< else
    std::vector<std::string> removal_notes = {};     ///< samples that are left out, sources that cannot be
    std::vector<std::string> rejected_sources = {};  ///< sources of power that are not taken, and why

    const Track& track() const { return logged != nullptr ? *logged : derived; }
    /// To be changed: a copy, where it was one of the series' own.
    Track& own() {
        if (logged != nullptr) derived = *std::exchange(logged, nullptr);
        return derived;
    }
};

/// What several values at the same time become.
enum class Merge {
    mean,   ///< measurements
    latest  ///< counters and states: the one that stands last in the log
};

/// A track, without a name, from raw rows: values that are not finite are dropped, times sorted, equal times merged.
/// `time_s` and `values` are equally long.
Track make_track(const std::vector<double>& time_s, std::vector<double> values, Merge merge);

/// Takes the samples out of the track for whose number is_out is true. Returns how many.
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

/// The last value at or before `time_s` (the first value before the track begins). Not for an empty track.
double state_at(const Track& track, double time_s);

/// value_at for every time, in one pass: `time_s` must rise.
std::vector<double> resample(const Track& track, const std::vector<double>& time_s);

/// Integral of any channel over time between two times, linear between samples [channel * s].
double integrated(const std::vector<double>& time_s, const std::vector<double>& values, double start_s, double end_s);

/// A longer interval without a power sample is a gap: three usual ones, and 10 s at most [s].
double gap_threshold_s(const std::vector<double>& time_s);

/// Median interval of the power samples [s].
double median_interval_s(const std::vector<double>& time_s);

/// True if the track holds one value throughout (or nothing).
bool is_constant(const Track& track);

using telemetry::CurrentOrigin;

/// The log's clock began anew: what stands behind is another recording, or lies over the first.
struct ClockRestart {
    double visible_from_s = 0.0;  ///< a log that ends before this time shows nothing of it
    double from_s = 0.0;
    double to_s = 0.0;
    std::string message;
    bool operator==(const ClockRestart&) const = default;
};

/// One aircraft in one log, as it was logged: every track that could tell something, several of one name
/// where several messages tell it. What is taken for the altitude, the power ... is decided when it is asked
/// for (selected_track.h), so that a series which is cut equals the series of a log that ends there.
struct FlightSeries {
    std::string file;           ///< it was read from, for errors
    std::string flight;         ///< the log's name without folder and ending
    std::string aircraft_id;    ///< as the log writes it; empty if unknown (a plain CSV)
    std::string aircraft_name;  ///< from the .log; may be empty
    std::string firmware;       ///< from the .log: "fixedwing", "rotorcraft", "rover"; may be empty

    // Known before the flight, from the .log.
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::optional<double> planned_ground_altitude_m;
    std::optional<double> start_clock_s;     ///< Unix time at which the log's own seconds begin
    std::map<int, std::string> block_names;  ///< of the track "block"
    bool log_is_missing = false;             ///< telemetry without its .log

    std::vector<Track> tracks;  ///< in the order of track_names(), of one name the best first
    std::vector<telemetry::AssumedDefinition> assumed_definitions;
    std::vector<telemetry::SkippedLines> skipped;  ///< by first line
    std::optional<ClockRestart> clock_restart;
    std::vector<std::string> notes;  ///< what was done to it, for its reader

    bool operator==(const FlightSeries&) const = default;
};

/// Every name that a track can have, in the order of the series file's columns: altitude_m,
/// throttle_percent, voltage_v, current_a, power_w, charge_ah, energy_wh, east_m, north_m, ...
const std::vector<std::string>& track_names();

/// Puts a track into the series in place of all of its name.
void replace_track(FlightSeries& series, Track track);

/// The series as it would have been read from a log that ends at `until_s` (the log's own seconds), in every
/// field: nothing later is left. What is known before a flight stays.
FlightSeries truncate_series(const FlightSeries& series, double until_s);
/// In place.
FlightSeries truncate_series(FlightSeries&& series, double until_s);

}  // namespace flightwatt::flight
