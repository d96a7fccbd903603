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

constexpr double min_current_fraction = 0.02;  // of the largest mean current; less is a spare input
// Packs of as many cells are at most as far apart: 4.2 V a cell when full, 3.15 V when empty.
constexpr double max_voltage_difference = 0.25;

struct Battery {
    std::string id;
    double mean_a = 0.0;
    double mean_v = 0.0;
    std::string exclusion = {};
};

/// Message of the batteries that a log numbers: "BAT"; empty without any.
std::string message_of_batteries(const FlightSeries& series) {
    for (const auto& track : series.tracks)
        if (track.name == "power_w" && !track.device.empty() && !track.empty() &&
            track.source.find(" * ") != std::string::npos)
            return track.source.substr(0, track.source.find('.'));
    return "";
}

/// The batteries that have a current, the one that draws most first.
std::vector<Battery> batteries_of(const FlightSeries& series, std::string_view message) {
    std::vector<Battery> batteries;
    const auto voltages = devices_of(series, "voltage_v", message);
    for (const auto& device : devices_of(series, "current_a", message)) {
        const auto voltage = std::ranges::find(voltages, device.id, &Device::id);
        if (voltage != voltages.end())
            batteries.push_back({device.id, mean(device.track.value), mean(voltage->track.value)});
    }
    std::ranges::stable_sort(batteries, std::greater(), &Battery::mean_a);
    for (auto& battery : batteries) {
        const auto& main = batteries.front();
        if (battery.mean_a < min_current_fraction * main.mean_a)
            battery.exclusion = "a spare input, as it draws less than 2 % of the current";
        else if (std::abs(battery.mean_v - main.mean_v) > max_voltage_difference * main.mean_v)
            battery.exclusion = "a circuit of its own, as its voltage is another";
    }
    return batteries;
}

std::vector<std::string> describe_choice(const std::vector<Battery>& batteries, const std::string& message) {
    std::vector<std::string> used;
    const auto name_of = [&](const Battery& battery) {
        return fmt::format("{} {} ({:.2f} V, {:.2f} A)", message, battery.id, battery.mean_v, battery.mean_a);
    };
    for (const auto& battery : batteries)
        if (battery.exclusion.empty()) used.push_back(name_of(battery));
    std::vector<std::string> notes;
    if (used.size() > 1)
        notes.push_back(fmt::format("the power is the sum over the batteries {}", fmt::join(used, " and ")));
    for (const auto& battery : batteries)
        if (!battery.exclusion.empty())
            notes.push_back(fmt::format("{} is not counted: {}; the power is that of {}", name_of(battery),
                                        battery.exclusion, fmt::join(used, " and ")));
    return notes;
}

}  // namespace

std::optional<TrackSelection> battery_track(const FlightSeries& series, std::string_view name) {
    constexpr std::string_view summed[] = {"power_w", "charge_ah", "energy_wh", "current_a"};
    const bool is_sum = std::ranges::find(summed, name) != std::end(summed);
    if (!is_sum && name != "voltage_v") return std::nullopt;
    const auto message = message_of_batteries(series);
    const auto batteries = batteries_of(series, message);
    if (message.empty() || batteries.empty()) return std::nullopt;
    std::set<std::string> excluded;
    for (const auto& battery : batteries)
        if (!battery.exclusion.empty()) excluded.insert(battery.id);
    TrackSelection choice;
    if (is_sum && batteries.size() - excluded.size() > 1) {
        auto sum = sum_over_devices(series, name, message, excluded);
        choice.track = std::move(sum.track);
        if (name == "power_w") choice.removal_notes = std::move(sum.notes);
        if (name == "power_w" && !sum.ambiguity.empty()) choice.rejected_sources.push_back(std::move(sum.ambiguity));
    } else {
        const auto own = std::ranges::find_if(series.tracks, [&](const Track& track) {
            return track.name == name && track.device == batteries.front().id && track.source.starts_with(message);
        });
        if (own != series.tracks.end()) choice.track = *own;
        choice.track.device.clear();
    }
    if (name == "power_w")
        std::ranges::move(describe_choice(batteries, message), std::back_inserter(choice.removal_notes));
    return choice;
}

}  // namespace flightwatt::flight
