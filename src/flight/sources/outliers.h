#pragma once

#include "flight/flight_series.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// Whether that leaves all of it.
bool is_plausible(const Track& track);

/// The times, rising, at which power is not voltage times current although it usually is: more than 10 % and 1 W
/// apart (ten times the median difference, where that is more). `product` is voltage times current of the same
/// message. Nothing where most samples differ: that is another layout, not damage.
std::vector<double> inconsistent_times(const Track& power, const Track& product);

/// The times, rising, of samples that nothing before and after them explains. Of power and current: one or two samples
/// of more than three times what was ever held for three samples, and of more than twice their neighbours. Of voltage:
/// one or two samples that differ from the neighbours, which agree, by more than 30 %. Of counters: a sample that
/// alone is out of their order by more than 1 % of what was counted. A sample is judged once another follows it.
std::vector<double> spike_times(const Track& track);

/// The times, rising, of samples of power or current that dropped out: up to three in a row at exactly 0 while the
/// throttle stands above 30 %, as it does before and after, where there is more than a quarter of the median at such a
/// throttle. A motor that is cut for so short a time has its throttle closed.
std::vector<double> dropout_times(const Track& track, const Track& throttle);

/// The track without its samples at `times_s`, which rise.
Track without_times(Track track, const std::vector<double>& times_s);

/// A candidate without what cannot be.
struct CleanedTrack {
    Track track = {};  ///< empty if nothing of it is to be believed
    bool is_unchanged =
        false;  ///< nothing is left out: the candidate itself counts, of which there is no copy in `track`
    std::string removal_note =
        {};  ///< "3 of 628 samples of power_w (ENERGY.power) are left out: ..."; empty if none is

    const Track& of(const Track& candidate) const { return is_unchanged ? candidate : track; }
    Track take(const Track& candidate) { return is_unchanged ? Track(candidate) : std::move(track); }
};

/// Leaves out the samples beyond the physical bounds, those at `contradicted_s` (rising), dropouts as `throttle` (empty
/// if not known) tells, and spikes.
CleanedTrack remove_outliers(const Track& candidate, const std::vector<double>& contradicted_s = {},
                             const Track& throttle = {});

}  // namespace flightwatt::flight
