#pragma once

#include "flight/flight_series.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// One of several that send the same message, and what it reports more than once at one time.
struct Device {
    std::string id;
    Track track;
    std::vector<Track> repeated;
};

/// The devices of `message` that report `name`, the one with most reports first; of each what can be.
std::vector<Device> devices_of(const FlightSeries& series, std::string_view name, std::string_view message);

/// True of what is no device, beside one of `most` reports: less than 1 % as many, or fewer than 3 of 30.
bool reports_rarely(const Device& device, std::size_t most);

}  // namespace flightwatt::flight
