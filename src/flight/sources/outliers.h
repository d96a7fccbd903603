#pragma once

#include "flight/flight_series.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// What a quantity of a small unmanned aircraft can be.
struct PhysicalBounds {
    double low = 0.0;
    double high = 0.0;
};

/// The bounds of a track by its name, in its unit (docs/methods.md); std::nullopt where it has none. They are so wide
/// that only damage or another unit lies beyond: no land lies lower than -430 m, and no small electric aircraft has
/// flown higher than 20 km.
std::optional<PhysicalBounds> physical_bounds(std::string_view track_name);

/// The track without the samples beyond its bounds; empty where these are more than a tenth: then the unit or the
/// layout is another one, and nothing of the track is to be believed.
Track within_bounds(const Track& track);

/// Takes the samples at `times_s`, which rise, out of the track. Returns how many.
std::size_t erase_times(Track& track, const std::vector<double>& times_s);

/// The candidate without what cannot be, and what was left out and why: the samples beyond the physical bounds, those
/// at `contradicted_s` (rising), dropouts as `throttle` (empty if not known) tells, and spikes. Empty if nothing of it
/// can be used.
TrackSelection remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s = {},
                               const Track& throttle = {});

}  // namespace flightwatt::flight
