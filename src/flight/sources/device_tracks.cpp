#include "flight/sources/device_tracks.h"

#include "flight/physical_bounds.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <functional>

namespace flightwatt::flight {

std::vector<Device> devices_of(const FlightSeries& series, std::string_view name, std::string_view message) {
    std::vector<Device> devices;
    for (const auto& track : series.tracks) {
        const bool is_device = track.name == name && !track.device.empty() && !track.empty() &&
                               track.source.substr(0, track.source.find('.')) == message;
        if (!is_device) continue;
        const auto id = track.device.substr(0, track.device.find(report_separator));
        const auto known = std::ranges::find(devices, id, &Device::id);
        if (known != devices.end()) {
            known->repeated.push_back(track);
        } else if (auto sound = within_bounds(track); !sound.empty()) {
            devices.push_back({id, std::move(sound), {}});
        }
    }
    std::ranges::stable_sort(devices, std::ranges::greater(), [](const Device& d) { return d.track.time_s.size(); });
    return devices;
}

bool reports_rarely(const Device& device, std::size_t most) {
    constexpr double hardly_fraction = 0.01;
    constexpr std::size_t hardly_reports = 3;
    constexpr std::size_t enough_to_tell = 30;
    const auto reports = device.track.time_s.size();
    return static_cast<double>(reports) < hardly_fraction * static_cast<double>(most) ||
           (reports < hardly_reports && most >= enough_to_tell);
}

}  // namespace flightwatt::flight
