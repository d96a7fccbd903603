#pragma once

#include "flight/flight_series.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Median of an odd number of values around each: takes out spikes of less than half as many, and leaves climbs as they
/// are.
template <std::size_t Width>
std::vector<double> running_median(const std::vector<double>& values) {
    constexpr auto reach = static_cast<std::ptrdiff_t>(Width / 2);
    std::vector<double> smooth = values;
    for (std::ptrdiff_t i = reach; i + reach < static_cast<std::ptrdiff_t>(values.size()); ++i) {
        std::array<double, Width> near{};
        std::copy_n(values.begin() + i - reach, Width, near.begin());
        std::nth_element(near.begin(), near.begin() + reach, near.end());
        smooth[static_cast<std::size_t>(i)] = near[Width / 2];
    }
    return smooth;
}

/// The altitude that phases are found by: without single spikes and excursions.
struct CleanedAltitude {
    Track altitude;
    std::vector<double> jumps_s;        ///< the first times after jumps: from there on its ground is another one
    std::vector<std::string> warnings;  ///< what was left out, and the jumps
    std::string unusable_reason;        ///< why nothing can be concluded from it; empty if something can
};

CleanedAltitude clean_altitude(Track altitude);

}  // namespace flightwatt::flight
