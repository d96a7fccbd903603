#pragma once

#include "flight/flight_series.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The altitude for the segmentation, without spikes and excursions, and what was found in it.
struct CleanedAltitude {
    Track altitude;
    std::vector<double> jumps_s;        ///< first times after jumps, from which the ground level differs
    std::vector<std::string> warnings;  ///< about removed samples and jumps
    std::string unusable_reason;        ///< reason why it cannot be used; empty if it can
};

/// Removes spikes and excursions of an altitude, and finds its jumps.
CleanedAltitude clean_altitude(Track altitude);

}  // namespace flightwatt::flight
