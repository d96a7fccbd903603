#pragma once

#include "flight/flight_series.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// One of several devices that send the same message.
struct Device {
    std::string name;  ///< "ESC 3", "BAT 0"
    std::string id;
    Track track;
    std::vector<Track> repeated;  ///< second, third ... reports of one time
};

/// Returns the devices of `message` that report the track `name`, the one with most reports first, with values within
/// physical bounds.
std::vector<Device> devices_of(const FlightSeries& series, std::string_view name, std::string_view message);

/// Returns whether a device reports too rarely to be one: less than 1 % of the reports of the most frequent one, or
/// fewer than 3 of 30.
bool reports_rarely(const Device& device, std::size_t max_reports);

/// The sum over devices (ESCs, circuits) that report one at a time.
struct DeviceSum {
    Track track;            ///< on the clock of the device that reports most; empty if none does
    std::string ambiguity;  ///< reason why there is no sum: several devices have one id, or one is mostly silent
    std::vector<std::string> notes;  ///< about devices that become silent or report rarely
};

/// Returns the sum over devices at the times at which none is silent (docs/methods.md). The track's `source` states
/// their number.
DeviceSum sum_over_devices(std::vector<Device> devices);

/// Returns whether a track is a sum over more than one device.
bool is_sum_over_devices(const Track& track);

/// Separates id and number in the device of a track with second, third ... reports of one time: "0~2", "0~3".
inline constexpr char report_separator = '~';

}  // namespace flightwatt::flight
