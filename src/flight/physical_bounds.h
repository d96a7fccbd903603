#pragma once

#include "flight/flight_series.h"

#include <optional>
#include <string_view>

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

/// Whether that leaves all of it.
bool is_plausible(const Track& track);

}  // namespace flightwatt::flight
