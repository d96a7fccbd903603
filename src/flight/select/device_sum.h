#pragma once

#include "flight/flight_series.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// One of several senders of the same message.
struct Device {
    std::string name;  ///< "ESC 3", "BAT 0"
    std::string id;
    Track track;
    std::vector<Track> repeated;  ///< second, third ... reports of one time
};

/// The devices of `message` that report `name`, the one with most reports first; values within physical bounds.
std::vector<Device> devices_of(const FlightSeries& series, std::string_view name, std::string_view message);

/// Whether it has less than 1 % of the most reports of a device, or fewer than 3 of 30: not a device.
bool reports_rarely(const Device& device, std::size_t max_reports);

/// Sum over devices (ESCs, circuits) that report one at a time.
struct DeviceSum {
    Track track;                     ///< on the clock of the device that reports most; empty if none does
    std::string ambiguity;           ///< why there is no sum: several devices have one id, or one is mostly silent
    std::vector<std::string> notes;  ///< devices that become silent or report rarely
};

/// Sum over devices at the times at which none is silent (docs/methods.md). The track's `source` states their number.
DeviceSum sum_over_devices(std::vector<Device> devices);

/// Whether the track is a sum over more than one device.
bool is_sum_over_devices(const Track& track);

/// In the device of a track with second, third ... reports of one time: "0~2", "0~3".
inline constexpr char report_separator = '~';

}  // namespace flightwatt::flight
