#pragma once

#include "flight/flight_series.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// What several values at the same time become.
enum class Merge {
    mean,   ///< measurements
    latest  ///< counters and states: the one that stands last in the log
};

/// A track, without a name, from raw rows: values that are not finite are dropped, times sorted, equal times merged.
/// `time_s` and `values` are equally long.
Track make_track(const std::vector<double>& time_s, const std::vector<double>& values, Merge merge);

/// Linear between the track's points, its first and last value outside. The track must not be empty.
double value_at(const Track& track, double time_s);

/// The last value at or before `time_s` (the first value before the track begins). Not for an empty track.
double state_at(const Track& track, double time_s);

/// value_at for every time, in one pass: `time_s` must rise.
std::vector<double> resample(const Track& track, const std::vector<double>& time_s);

/// True if the track holds one value throughout (or nothing).
bool is_constant(const Track& track);

}  // namespace flightwatt::flight
