#pragma once

#include "flight/flight_data.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The physical range of a quantity of a small unmanned aircraft.
struct PhysicalBounds {
    double low = 0.0;
    double high = 0.0;
};

/// Returns the bounds of a track by its name, in its unit (docs/methods.md); std::nullopt if it has none. Values beyond
/// are damaged or in another unit: no land is lower than -430 m, no small electric aircraft has flown above 20 km.
std::optional<PhysicalBounds> physical_bounds(std::string_view track_name);

/// Returns the track without samples beyond its bounds; empty if these are more than a tenth (another unit or layout).
Track within_bounds(const Track& track);

/// Removes the samples at `times_s`, which rise. Returns their number.
std::size_t erase_times(Track& track, const std::vector<double>& times_s);

/// Returns the candidate without impossible samples, with notes about them: samples beyond the physical bounds, samples
/// at `contradicted_s` (rising), dropouts by `throttle` (empty if unknown), and spikes. Speeds below 0 are 0. Empty if
/// none is usable.
ChosenTrack remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s = {},
                            const Track& throttle = {});

}  // namespace flightwatt::flight
