#include "flight/flight_identity.h"

#include "base/fingerprint.h"
#include "flight/flight_phases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <string_view>
#include <vector>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

/// Tracks that identify a flight: altitude, voltage, current and power that vary.
bool identifies(const Track& track) {
    constexpr std::array<std::string_view, 4> names{"altitude_m", "voltage_v", "current_a", "power_w"};
    return std::ranges::find(names, track.name) != names.end() && !is_constant(track);
}

/// The means of a track's quarters in steps of a thousandth of its largest magnitude: a copy whose samples were rounded,
/// as by a program that writes them as text, has the same.
std::string rounded_means(const std::vector<double>& values) {
    constexpr std::size_t parts = 4;
    constexpr double steps = 2048.0;  // up to the next power of two
    double largest = 0.0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    int exponent = 0;
    const double scale = steps * std::frexp(largest, &exponent);
    auto text = fmt::format("{} {}", values.size(), exponent);
    for (std::size_t part = 0; part < parts; ++part) {
        const auto begin = values.size() * part / parts;
        const auto end = values.size() * (part + 1) / parts;
        double sum = 0.0;
        for (auto i = begin; i < end; ++i) sum += values[i] / largest;
        if (end > begin) text += fmt::format(" {}", std::lround(scale * sum / static_cast<double>(end - begin)));
    }
    return text;
}

}  // namespace

std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name) {
    constexpr int century = 2000;
    constexpr int hours_a_day = 24;
    constexpr int sixty = 60;  // minutes, and seconds
    static const std::regex pattern(
        "(?:^|[^0-9])([0-9]{2})_([0-9]{2})_([0-9]{2})__([0-9]{2})_([0-9]{2})_([0-9]{2})(?:$|[^0-9])");
    std::smatch found;
    if (!std::regex_search(name, found, pattern)) return std::nullopt;
    const auto part = [&](std::size_t group) { return std::stoi(found[group].str()); };
    const std::chrono::year_month_day date{std::chrono::year{century + part(1)},
                                           std::chrono::month{static_cast<unsigned>(part(2))},
                                           std::chrono::day{static_cast<unsigned>(part(3))}};
    if (!date.ok() || part(4) >= hours_a_day || part(5) >= sixty || part(6) >= sixty) return std::nullopt;
    return std::chrono::sys_days{date} + std::chrono::hours{part(4)} + std::chrono::minutes{part(5)} +
           std::chrono::seconds{part(6)};
}

std::optional<double> start_clock_s(const std::optional<double>& logged_s, const std::string& name) {
    if (logged_s && *logged_s > 0.0) return logged_s;
    const auto start = start_in_name(name);
    return start ? std::optional(static_cast<double>(start->time_since_epoch().count())) : std::nullopt;
}

FlightContent content_of(const FlightSeries& series) {
    FlightContent content;
    content.has_definitions = !series.log_is_missing;
    Fingerprint fingerprint;
    bool is_known = false;
    for (const auto& track : series.tracks) {
        if (!identifies(track)) continue;
        fingerprint.add(fmt::format("{} {} {}\n", track.name, track.source, rounded_means(track.value)));
        is_known = true;
    }
    if (is_known) content.fingerprint = fingerprint.value();
    return content;
}

bool is_synthetic(const std::string& aircraft_name) { return boost::algorithm::icontains(aircraft_name, "synthetic"); }

bool is_simulated(const std::string& aircraft_name) {
    return aircraft_name.find("SITL") != std::string::npos || aircraft_name.find("HITL") != std::string::npos ||
           aircraft_name == "NPS" || aircraft_name.ends_with(" NPS");
}

std::string describe_aircraft(const std::string& id, const std::string& name) {
    if (id.empty() && name.empty()) return "unknown";
    return fmt::format("{}{}{}{}", id, id.empty() || name.empty() ? "" : " ", name,
                       is_synthetic(name)   ? " (SYNTHETIC)"
                       : is_simulated(name) ? " (SIMULATED)"
                                            : "");
}

}  // namespace flightwatt::flight
