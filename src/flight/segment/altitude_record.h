#pragma once

#include "flight/flight_series.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The altitude for the segmentation, without spikes and excursions.
struct CleanedAltitude {
    Track altitude;
    std::vector<double> jumps_s;        ///< first times after jumps, from which on the ground level differs
    std::vector<std::string> warnings;  ///< removed samples, and jumps
    std::string unusable_reason;        ///< why it cannot be used; empty if it can
};

CleanedAltitude clean_altitude(Track altitude);

}  // namespace flightwatt::flight
