#pragma once

#include "flight/flight_series.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// From one sample to the next an altitude changes by no more than this, or it has jumped: 60 m/s is more than a small
/// aircraft climbs or dives, and an estimator may correct itself by 10 m.
inline constexpr double jump_m = 10.0;
inline constexpr double jump_m_per_s = 60.0;
/// The same beside a time in which it repeated one value (an estimator without a fix), and over a time left out.
inline constexpr double fix_jump_m = 60.0;
inline constexpr double fix_jump_m_per_s = 5.0;
/// An altitude that comes back from a jump within this time was somewhere else meanwhile [s].
inline constexpr double excursion_s = 30.0;
/// So did one that stood still meanwhile, as an estimator does that has lost its fix [s].
inline constexpr double fix_loss_s = 120.0;
/// With more jumps than this nothing can be concluded from an altitude.
inline constexpr std::size_t max_jumps = 10;

/// The altitude that phases are found by: without single spikes and excursions.
struct CleanedAltitude {
    Track altitude;
    std::vector<double> jumps_s;        ///< the first times after jumps: from there on its ground is another one
    std::vector<std::string> warnings;  ///< what was left out, and the jumps
    std::string unusable_reason;        ///< why nothing can be concluded from it; empty if something can
};

CleanedAltitude clean_altitude(Track altitude);

}  // namespace flightwatt::flight
