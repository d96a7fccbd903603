#include "flight/select/device_sum.h"

#include "flight/select/outliers.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr std::string_view summed_over = ", summed over ";
constexpr double silent_intervals = 5.0;
constexpr double outside_intervals = 3.0;
constexpr double near_intervals = 0.9;
constexpr double repeated_fraction = 0.05;    // of a device's reports: less is damage
constexpr double min_summed_fraction = 0.25;  // of the times: with less there is no power record

/// Detects several devices with one id by their reports of one time.
void check_ids(const std::vector<Device>& devices, DeviceSum& sum) {
    for (const auto& device : devices) {
        const auto& track = device.track;
        const auto is_often = [&](std::size_t reports) {
            return static_cast<double>(reports) > repeated_fraction * static_cast<double>(track.time_s.size());
        };
        std::size_t reports = 0;  // further ones of a time
        std::size_t differing = 0;
        for (const auto& more : device.repeated) {
            reports += more.time_s.size();
            for (std::size_t i = 0; i < more.time_s.size(); ++i)
                differing += value_at(track, more.time_s[i]) != more.value[i] ? 1 : 0;
        }
        const bool differ = 2 * differing > reports;
        const auto times = device.repeated.size() + 1;
        if (is_often(reports) && (differ || (times > 2 && is_often(device.repeated.back().time_s.size())))) {
            sum.ambiguity = fmt::format("{} reports {} times at one time{}: several devices have this id", device.name,
                                        times, differ ? ", and differently" : "");
        } else if (devices.size() == 1 && is_often(reports)) {
            sum.notes.push_back(fmt::format(
                "{} reports up to {} times at one time: repeated lines, or several devices with this id; counted once",
                device.name, times));
        }
    }
}

/// The device's value at a time; std::nullopt if it is silent. Devices report one after the other, so a report within
/// an interval before or after a gap of all devices counts.
std::optional<double> report_at(const Track& track, double median_s, double time_s) {
    const auto after = std::ranges::upper_bound(track.time_s, time_s);
    const bool begun = after != track.time_s.begin();
    const double since_s = begun ? time_s - *(after - 1) : 0.0;
    if (begun && since_s == 0.0) return value_at(track, time_s);
    if (after == track.time_s.end())
        return since_s > outside_intervals * median_s ? std::nullopt : std::optional(track.value.back());
    const double until_s = *after - time_s;
    if (!begun) return until_s > outside_intervals * median_s ? std::nullopt : std::optional(track.value.front());
    if (since_s + until_s <= silent_intervals * median_s) return value_at(track, time_s);
    if (std::min(since_s, until_s) > near_intervals * median_s) return std::nullopt;
    const auto nearest = after - track.time_s.begin() - (since_s < until_s ? 1 : 0);
    return track.value[static_cast<std::size_t>(nearest)];
}

/// Adds a device where it reports and drops the other times of the sum.
void add_device(Track& sum, const Device& device, double clock_s, std::vector<std::string>& notes) {
    const double median_s = std::max(median_interval_s(device.track.time_s), clock_s);
    Track total{sum.name, sum.source, sum.device, sum.since_s, {}, {}};
    std::optional<double> silent_from_s;
    for (std::size_t i = 0; i < sum.time_s.size(); ++i) {
        const auto more = report_at(device.track, median_s, sum.time_s[i]);
        if (!more) {
            if (!silent_from_s) silent_from_s = sum.time_s[i];
            continue;
        }
        total.time_s.push_back(sum.time_s[i]);
        total.value.push_back(sum.value[i] + *more);
    }
    if (silent_from_s) {
        notes.push_back(fmt::format(
            "{} is silent at {} of {} times, first at {:.1f} s: the sum over the devices has no value there",
            device.name, sum.time_s.size() - total.time_s.size(), sum.time_s.size(), *silent_from_s));
    }
    sum = std::move(total);
}

}  // namespace

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
        } else if (auto valid = within_bounds(track); !valid.empty()) {
            devices.push_back({fmt::format("{} {}", message, id), id, std::move(valid), {}});
        }
    }
    std::ranges::stable_sort(devices, std::ranges::greater(), [](const Device& d) { return d.track.time_s.size(); });
    return devices;
}

bool reports_rarely(const Device& device, std::size_t max_reports) {
    constexpr double min_fraction = 0.01;
    constexpr std::size_t min_reports = 3;
    constexpr std::size_t enough_reports = 30;
    const auto reports = device.track.time_s.size();
    return static_cast<double>(reports) < min_fraction * static_cast<double>(max_reports) ||
           (reports < min_reports && max_reports >= enough_reports);
}

DeviceSum sum_over_devices(std::vector<Device> devices) {
    DeviceSum sum;
    std::erase_if(devices, [](const Device& device) { return device.track.empty(); });
    if (devices.empty()) return sum;
    std::ranges::stable_sort(devices, std::ranges::greater(), [](const Device& d) { return d.track.time_s.size(); });
    const auto max_reports = devices.front().track.time_s.size();
    std::erase_if(devices, [&](const Device& device) {
        const bool is_rare = reports_rarely(device, max_reports);
        if (is_rare) {
            sum.notes.push_back(fmt::format("{} reports only {} times: it is excluded from the sum", device.name,
                                            device.track.time_s.size()));
        }
        return is_rare;
    });
    check_ids(devices, sum);
    if (!sum.ambiguity.empty()) return sum;
    sum.track = devices.front().track;
    const double clock_s = median_interval_s(sum.track.time_s);
    for (std::size_t d = 1; d < devices.size(); ++d) add_device(sum.track, devices[d], clock_s, sum.notes);
    if (static_cast<double>(sum.track.time_s.size()) < min_summed_fraction * static_cast<double>(max_reports)) {
        sum.ambiguity = sum.notes.back();
        sum.track = {};
        return sum;
    }
    sum.track.device.clear();
    sum.track.source = fmt::format("{}{}{} devices", sum.track.source, summed_over, devices.size());
    return sum;
}

bool is_sum_over_devices(const Track& track) {
    const auto at = track.source.find(summed_over);
    return at != std::string::npos && track.source.substr(at + summed_over.size()) != "1 devices";
}

}  // namespace flightwatt::flight
