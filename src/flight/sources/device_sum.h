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

/// What several devices (ESCs, circuits) report one at a time, in sum.
struct DeviceSum {
    Track track;                     ///< on the clock of the device that reports most; empty if none does
    std::string ambiguity;           ///< why there is no sum: one id stands for several devices, one is mostly silent
    std::vector<std::string> notes;  ///< devices that fall silent, that hardly report, that come in bursts
};

/// Sum over the devices of `message` that report `name`, where every device reports (docs/methods.md says when one is
/// silent, and when ids do not tell devices apart). `source` says of how many.
DeviceSum sum_over_devices(const FlightSeries& series, std::string_view name, std::string_view message);

/// Whether that made the track, of more than one device.
bool is_sum_over_devices(const Track& track);

/// Several reports of one device at one time are tracks of their own: "0", "0~2" for the second, "0~3" ...
inline constexpr char report_separator = '~';

}  // namespace flightwatt::flight
