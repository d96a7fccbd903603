#include "flight/sources/batteries.h"

#include "base/statistics.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double min_current_fraction = 0.02;    // of the largest mean current; less is a spare input
constexpr double max_voltage_difference = 0.10;  // of batteries in parallel
constexpr std::string_view product_sign = " * ";

struct Battery {
    std::string id;
    double mean_a = 0.0;
    double mean_v = 0.0;
};

/// The batteries of a log: those in parallel that draw current, and the others with the reason.
struct Batteries {
    std::string message;
    std::vector<Battery> used;  ///< the one that draws most first
    std::vector<std::pair<Battery, std::string>> excluded;
};

double mean_of(const FlightSeries& series, std::string_view name, const std::string& message, const std::string& id) {
    for (const auto& track : series.tracks) {
        if (track.name == name && track.device == id && !track.empty() &&
            track.source.substr(0, track.source.find('.')) == message)
            return mean(track.value);
    }
    return 0.0;
}

Batteries batteries_of(const FlightSeries& series) {
    Batteries batteries;
    std::vector<Battery> all;
    for (const auto& track : series.tracks) {
        const bool is_battery = track.name == "power_w" && !track.device.empty() && !track.empty() &&
                                track.source.find(product_sign) != std::string::npos;
        if (!is_battery) continue;
        const auto message = track.source.substr(0, track.source.find('.'));
        if (batteries.message.empty()) batteries.message = message;
        if (message != batteries.message) continue;
        all.push_back({track.device, mean_of(series, "current_a", message, track.device),
                       mean_of(series, "voltage_v", message, track.device)});
    }
    if (all.empty()) return batteries;
    std::ranges::stable_sort(all, std::greater(), &Battery::mean_a);
    for (auto& battery : all) {
        const auto& main = all.front();
        const double apart_v = std::abs(battery.mean_v - main.mean_v);
        if (battery.mean_a < min_current_fraction * main.mean_a) {
            batteries.excluded.emplace_back(battery, "a spare input, as it draws less than 2 % of the current");
        } else if (apart_v > max_voltage_difference * main.mean_v) {
            batteries.excluded.emplace_back(battery, "a circuit of its own, as its voltage is another");
        } else {
            batteries.used.push_back(battery);
        }
    }
    return batteries;
}

/// "BAT 0 (16.1 V, 12.3 A)".
std::string describe_battery(const Batteries& of, const Battery& battery) {
    return fmt::format("{} {} ({:.2f} V, {:.2f} A)", of.message, battery.id, battery.mean_v, battery.mean_a);
}

std::vector<std::string> describe_choice(const Batteries& batteries) {
    std::vector<std::string> notes;
    std::vector<std::string> used;
    for (const auto& battery : batteries.used) used.push_back(describe_battery(batteries, battery));
    if (used.size() > 1)
        notes.push_back(fmt::format("the power is the sum over the batteries {}", fmt::join(used, " and ")));
    for (const auto& [battery, reason] : batteries.excluded)
        notes.push_back(fmt::format("{} is not counted: {}; the power is that of {}",
                                    describe_battery(batteries, battery), reason, fmt::join(used, " and ")));
    return notes;
}

/// The track of one battery, as that of the log.
Track track_of_battery(const FlightSeries& series, std::string_view name, const Batteries& batteries,
                       const std::string& id) {
    for (const auto& track : series.tracks) {
        if (track.name != name || track.device != id || track.empty() ||
            track.source.substr(0, track.source.find('.')) != batteries.message)
            continue;
        auto own = track;
        own.device.clear();
        return own;
    }
    return {};
}

}  // namespace

std::optional<TrackSelection> battery_track(const FlightSeries& series, std::string_view name) {
    constexpr std::string_view summed[] = {"power_w", "charge_ah", "energy_wh", "current_a"};
    const bool is_sum = std::ranges::find(summed, name) != std::end(summed);
    if (!is_sum && name != "voltage_v") return std::nullopt;
    const auto batteries = batteries_of(series);
    if (batteries.used.empty()) return std::nullopt;
    TrackSelection choice;
    if (batteries.used.size() == 1 || !is_sum) {
        choice.track = track_of_battery(series, name, batteries, batteries.used.front().id);
    } else {
        std::set<std::string> excluded;
        for (const auto& [battery, reason] : batteries.excluded) excluded.insert(battery.id);
        auto sum = sum_over_devices(series, name, batteries.message, excluded);
        choice.track = std::move(sum.track);
        if (name == "power_w") choice.removal_notes = std::move(sum.notes);
        if (name == "power_w" && !sum.ambiguity.empty()) choice.rejected_sources.push_back(std::move(sum.ambiguity));
    }
    if (name == "power_w") std::ranges::move(describe_choice(batteries), std::back_inserter(choice.removal_notes));
    return choice;
}

}  // namespace flightwatt::flight
