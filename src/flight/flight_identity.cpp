#include "flight/flight_identity.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

// A stretch is so many values in a row of which so many differ: shorter ones, and those of a state that hardly changes,
// recur in other flights.
constexpr std::size_t stretch_length = 12;
constexpr std::size_t least_different = 8;
constexpr std::size_t sketch_size = 128;
constexpr std::size_t least_shared = 4;
constexpr double least_part = 0.5;

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * 0x9E3779B97F4A7C15U;
    return state ^ (state >> 29);
}

std::size_t different_in(std::span<const double, stretch_length> values) {
    std::array<double, stretch_length> sorted{};
    std::ranges::copy(values, sorted.begin());
    std::ranges::sort(sorted);
    return static_cast<std::size_t>(std::ranges::unique(sorted).begin() - sorted.begin());
}

void add_stretches(const Track& track, std::uint64_t seed, std::vector<std::uint64_t>& stretches) {
    const std::span values(track.value);
    for (std::size_t i = 0; i + stretch_length <= values.size(); ++i) {
        const auto stretch = values.subspan(i).first<stretch_length>();
        if (different_in(stretch) < least_different) continue;
        auto state = seed;
        for (const double value : stretch) state = mixed(state, std::bit_cast<std::uint64_t>(value));
        stretches.push_back(mixed(state, stretch_length));
    }
}

}  // namespace

FlightContent content_of(const FlightSeries& series) {
    constexpr std::array<std::string_view, 4> names{"altitude_m", "voltage_v", "current_a", "power_w"};
    std::vector<std::uint64_t> stretches;
    for (const auto& track : series.tracks) {
        const auto* name = std::ranges::find(names, track.name);
        if (name == names.end()) continue;
        add_stretches(track, mixed(0, static_cast<std::uint64_t>(name - names.begin()) + 1), stretches);
    }
    std::ranges::sort(stretches);
    stretches.erase(std::unique(stretches.begin(), stretches.end()), stretches.end());
    FlightContent content{stretches.size(), std::move(stretches)};
    content.sketch.resize(std::min(content.sketch.size(), sketch_size));
    return content;
}

bool is_same_flight(const FlightContent& one, const FlightContent& other) {
    // The least of the union are a random sample of it; those in both tell which part of it is shared (Broder, "On the
    // resemblance and containment of documents", 1997).
    std::vector<std::uint64_t> all;
    std::ranges::set_union(one.sketch, other.sketch, std::back_inserter(all));
    all.resize(std::min(all.size(), sketch_size));
    const auto shared = std::ranges::count_if(all, [&](std::uint64_t stretch) {
        return std::ranges::binary_search(one.sketch, stretch) && std::ranges::binary_search(other.sketch, stretch);
    });
    if (static_cast<std::size_t>(shared) < std::min({least_shared, one.sketch.size(), other.sketch.size()}) ||
        shared == 0)
        return false;
    const double resemblance = static_cast<double>(shared) / static_cast<double>(all.size());
    const auto both = static_cast<double>(one.stretches + other.stretches);
    const auto shorter = static_cast<double>(std::min(one.stretches, other.stretches));
    return resemblance * both / (1.0 + resemblance) >= least_part * shorter;
}

std::optional<std::size_t> KnownFlights::find(const FlightContent& content) const {
    std::set<std::size_t> sharing;
    for (const auto stretch : content.sketch) {
        const auto known = with_stretch_.find(stretch);
        if (known != with_stretch_.end()) sharing.insert(known->second.begin(), known->second.end());
    }
    const auto same =
        std::ranges::find_if(sharing, [&](std::size_t known) { return is_same_flight(content, contents_[known]); });
    return same == sharing.end() ? std::nullopt : std::optional(*same);
}

void KnownFlights::add(FlightContent content) {
    for (const auto stretch : content.sketch) with_stretch_[stretch].push_back(contents_.size());
    contents_.push_back(std::move(content));
}

bool is_synthetic(const std::string& aircraft_name) { return boost::algorithm::icontains(aircraft_name, "synthetic"); }

std::string describe_aircraft(const std::string& id, const std::string& name) {
    if (id.empty() && name.empty()) return "unknown";
    return fmt::format("{}{}{}{}", id, id.empty() || name.empty() ? "" : " ", name,
                       is_synthetic(name) ? " (SYNTHETIC)" : "");
}

std::string describe_mix(std::span<const FlownBy> flights) {
    std::map<std::string, std::vector<std::string>> flown;  // by aircraft
    std::set<std::string> ids;
    std::set<std::string> names;
    for (const auto& [flight, id, name] : flights) {
        flown[describe_aircraft(id, name)].push_back(flight);
        if (!id.empty()) ids.insert(id);
        if (!name.empty()) names.insert(name);
    }
    names.erase(unnamed_synthetic);  // one without its .log goes with any other synthetic one of its id
    const auto synthetic =
        std::ranges::count_if(flights, [](const FlownBy& by) { return is_synthetic(by.aircraft_name); });
    const bool any_real = std::ranges::any_of(names, [](const auto& name) { return !is_synthetic(name); });
    if (ids.size() < 2 && names.size() < 2 && (synthetic == 0 || !any_real)) return "";
    std::vector<std::string> lines;
    for (const auto& [aircraft, its] : flown) lines.push_back(fmt::format("{}: {}", aircraft, fmt::join(its, ", ")));
    return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace flightwatt::flight
