#include "batch/aircraft.h"

#include "base/error.h"
#include "base/text.h"
#include "base/text_table.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "mechanical/measured_flight.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::batch {
namespace {

constexpr double full_cell_v = 4.45;  // of high voltage, charged to 4.35 V, with an error of the sensor
constexpr double empty_cell_v = 3.3;  // a LiPo cell at rest: with less, no flight begins
/// A copter hovers with twice its mass at 2^1.5 = 2.8 times the power. A wing at twice its speed of least power needs
/// 2.4 times that power. Payload and wind make smaller differences.
constexpr double max_power_ratio = 3.0;

/// Whether two names cannot be of one aircraft. A synthetic aircraft without a name may be any synthetic one.
bool names_differ(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || a == b) return false;
    const bool any_unnamed = a == flight::unnamed_synthetic || b == flight::unnamed_synthetic;
    return !any_unnamed || !flight::is_synthetic(a) || !flight::is_synthetic(b);
}

bool differ(const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; }

CellRange cells_of(const FlightAircraft& flight) {
    return flight.pack_voltage_v ? possible_cells(*flight.pack_voltage_v) : CellRange{};
}

CellRange common(const CellRange& a, const CellRange& b) { return {std::max(a.min, b.min), std::min(a.max, b.max)}; }

bool powers_differ(const FlightAircraft& flight, const AircraftGroup& group) {
    if (!flight.cruise_power_w || !group.min_power_w) return false;
    return *flight.cruise_power_w < std::min(*group.min_power_w, *group.max_power_w / max_power_ratio) ||
           *flight.cruise_power_w > std::max(*group.max_power_w, *group.min_power_w * max_power_ratio);
}

bool contradicts(const FlightAircraft& flight, const AircraftGroup& group) {
    if (differ(flight.id, group.id) || names_differ(flight.name, group.name) || differ(flight.kind, group.kind))
        return true;
    const auto cells = common(cells_of(flight), group.cells);
    const bool has_same_id = !flight.id.empty() && flight.id == group.id;
    return cells.min > cells.max || (!has_same_id && powers_differ(flight, group));
}

void join(const FlightAircraft& flight, std::size_t number, AircraftGroup& group) {
    if (group.id.empty()) group.id = flight.id;
    if (group.name.empty() || group.name == flight::unnamed_synthetic)
        group.name = flight.name.empty() ? group.name : flight.name;
    if (group.kind.empty()) group.kind = flight.kind;
    group.cells = common(group.cells, cells_of(flight));
    if (const auto power_w = flight.cruise_power_w) {
        group.min_power_w = std::min(*power_w, group.min_power_w.value_or(*power_w));
        group.max_power_w = std::max(*power_w, group.max_power_w.value_or(*power_w));
    }
    group.flights.push_back(number);
}

/// The numbers of the flights, those that state most first: the groups do not depend on the order of the logs.
std::vector<std::size_t> by_facts(std::span<const FlightAircraft> flights) {
    std::vector<std::size_t> order(flights.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        const auto& [flight, id, name, kind, voltage_v, power_w] = flights[i];
        const bool is_named = !name.empty() && name != flight::unnamed_synthetic;
        const int facts = int{is_named} + int{!kind.empty()} + int{voltage_v.has_value()} + int{power_w.has_value()};
        return std::tuple(id.empty(), -facts, power_w.value_or(0.0), std::string_view(flight));
    });
    return order;
}

/// The first division of the flights: each joins the first group that it does not contradict.
std::vector<AircraftGroup> first_groups(std::span<const FlightAircraft> flights, std::span<const std::size_t> order) {
    std::vector<AircraftGroup> groups;
    for (const auto number : order) {
        const auto& flight = flights[number];
        const auto fitting =
            std::ranges::find_if(groups, [&](const auto& group) { return !contradicts(flight, group); });
        join(flight, number, fitting == groups.end() ? groups.emplace_back() : *fitting);
    }
    return groups;
}

/// The numbers of the groups that a flight may belong to: of those with its id, if it has one.
std::vector<std::size_t> fitting_groups(const FlightAircraft& flight, std::span<const AircraftGroup> groups) {
    std::vector<std::size_t> fitting;
    for (std::size_t g = 0; g < groups.size(); ++g)
        if ((flight.id.empty() || flight.id == groups[g].id) && !contradicts(flight, groups[g])) fitting.push_back(g);
    return fitting;
}

/// Flights that fit the same groups, and do not contradict each other.
struct FittingFlights {
    std::vector<std::size_t> fitting;  ///< several: they may be of each
    AircraftGroup group;
};

/// What the groups are by the flights that state an id; groups without one as they are. A flight without an id that
/// joined one of them is no evidence against others.
std::vector<FittingFlights> divide(std::span<const FlightAircraft> flights) {
    const auto order = by_facts(flights);
    const auto without_id = std::ranges::find_if(order, [&](auto number) { return flights[number].id.empty(); });
    auto groups = first_groups(flights, order);
    std::ranges::copy(first_groups(flights, std::span(order.begin(), without_id)), groups.begin());
    std::vector<FittingFlights> all;
    for (const auto number : order) {
        const auto& flight = flights[number];
        auto fitting = fitting_groups(flight, groups);
        const auto same = std::ranges::find_if(
            all, [&](const auto& of) { return of.fitting == fitting && !contradicts(flight, of.group); });
        auto& joined = same == all.end() ? all.emplace_back(FittingFlights{std::move(fitting), {}}) : *same;
        join(flight, number, joined.group);
    }
    return all;
}

/// The shortest beginning of an id, from 8 characters on, that no other id has.
std::string short_id(const std::string& id, std::span<const AircraftGroup> groups) {
    constexpr std::size_t min_length = 8;
    for (auto length = min_length; length < id.size(); ++length) {
        auto prefix = id.substr(0, length);
        if (std::ranges::none_of(groups,
                                 [&](const auto& other) { return other.id != id && other.id.starts_with(prefix); }))
            return prefix;
    }
    return id;
}

/// Groups of known aircraft with this text.
std::vector<const AircraftGroup*> groups_with(std::span<const AircraftGroup> groups, const auto& matches) {
    std::vector<const AircraftGroup*> found;
    for (const auto& group : groups)
        if (group.may_be.empty() && matches(group)) found.push_back(&group);
    return found;
}

std::string selector_of(const AircraftGroup& group, std::span<const AircraftGroup> groups,
                        std::span<const FlightAircraft> flights) {
    const auto is_alone = [&](std::string AircraftGroup::*text) {
        return !(group.*text).empty() && std::ranges::count(groups, group.*text, text) == 1;
    };
    if (is_alone(&AircraftGroup::id)) return short_id(group.id, groups);
    return is_alone(&AircraftGroup::name) ? group.name : flights[group.flights.front()].flight;
}

std::vector<std::string> names_of(const AircraftGroup& group, std::span<const FlightAircraft> flights) {
    std::vector<std::string> names;
    names.reserve(group.flights.size());
    for (const auto number : group.flights) names.push_back(flights[number].flight);
    return names;
}

std::string cell_text(const CellRange& cells) {
    if (cells == CellRange{} || cells.min > cells.max) return "-";
    return cells.min == cells.max ? fmt::format("{}", cells.min) : fmt::format("{} to {}", cells.min, cells.max);
}

std::string power_text(const AircraftGroup& group) {
    if (!group.min_power_w) return "-";
    const auto low = fmt::format("{:.3g}", *group.min_power_w);
    const auto high = fmt::format("{:.3g}", *group.max_power_w);
    return low == high ? low : low + " to " + high;
}

/// Of a longer text its beginning, with "...".
std::string clipped(std::string text, std::size_t width) {
    if (character_count(text) <= width) return text;
    while (character_count(text) + 3 > width && !text.empty()) {
        while (text.size() > 1 && continues_character(text.back())) text.pop_back();
        text.pop_back();
    }
    return text + "...";
}

}  // namespace

FlightAircraft aircraft_of(const flight::LoadedFlight& loaded) {
    const auto& data = loaded.data;
    FlightAircraft aircraft{data.flight, data.aircraft_id, data.aircraft_name, data.firmware};
    aircraft.pack_voltage_v = mechanical::pack_voltage_v(data);
    if (!loaded.lacks_power.empty()) return aircraft;
    const flight::PowerStatistics power(data);
    double energy_j = 0.0;
    double duration_s = 0.0;
    for (const auto& sortie : loaded.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (span.phase != flight::Phase::cruise) continue;
            energy_j += span.duration_s() * power.between(span.start.time_s, span.end.time_s).mean_power_w;
            duration_s += span.duration_s();
        }
    }
    if (energy_j > 0.0) aircraft.cruise_power_w = energy_j / duration_s;
    return aircraft;
}

CellRange possible_cells(double pack_voltage_v) {
    if (!(pack_voltage_v > 0.0) || pack_voltage_v > 1e6) return {};
    constexpr double rounding = 1e-9;  // 5 * 3.3 / 3.3 < 5
    const int min = static_cast<int>(std::ceil(pack_voltage_v / full_cell_v - rounding));
    return {min, std::max(min, static_cast<int>(pack_voltage_v / empty_cell_v + rounding))};
}

std::vector<AircraftGroup> group_aircraft(std::span<const FlightAircraft> flights) {
    auto all = divide(flights);
    // As a range it is more than clang 14 compiles, which builds the fuzz targets.
    const auto others =
        std::stable_partition(all.begin(), all.end(), [](const auto& of) { return of.fitting.size() == 1; });
    const auto known = static_cast<std::size_t>(others - all.begin());
    std::vector<AircraftGroup> groups;
    for (auto& of : all) {
        std::ranges::sort(of.group.flights);
        groups.push_back(std::move(of.group));
    }
    const std::span certain(groups.data(), known);
    for (auto& group : certain) group.selector = selector_of(group, certain, flights);
    for (auto g = known; g < groups.size(); ++g) {
        const auto& first = flights[groups[g].flights.front()];
        groups[g].selector = first.flight;
        for (std::size_t c = 0; c < known; ++c)
            if (std::ranges::find(all[g].fitting, all[c].fitting.front()) != all[g].fitting.end())
                groups[g].may_be.push_back(groups[c].selector);
    }
    std::ranges::sort(groups, {}, [](const auto& group) { return group.flights.front(); });
    return groups;
}

const AircraftGroup& find_aircraft(const std::string& text, std::span<const AircraftGroup> groups,
                                   std::span<const FlightAircraft> flights) {
    auto found = groups_with(groups, [&](const auto& group) { return !text.empty() && group.id == text; });
    const auto is_named = [&](std::size_t number) { return flights[number].flight == text; };
    for (const auto& group : groups)
        if (found.empty() && std::ranges::any_of(group.flights, is_named)) found.push_back(&group);
    if (found.empty())
        found = groups_with(groups, [&](const auto& group) { return !text.empty() && group.name == text; });
    if (found.empty() && text.size() >= flight::min_id_beginning)
        found = groups_with(groups, [&](const auto& group) { return group.id.starts_with(text); });
    if (found.size() == 1) return *found.front();
    throw UsageError(fmt::format("--aircraft {}: {}; there are: {}", text,
                                 found.empty() ? "there is no such aircraft" : "it names several aircraft",
                                 list_aircraft(groups, flights)));
}

std::string aircraft_table(std::span<const AircraftGroup> groups, std::span<const FlightAircraft> flights,
                           std::size_t width) {
    constexpr std::size_t max_name = 14;
    constexpr std::size_t min_flights = 10;
    TextTable table{{"aircraft", "name", "kind", "cells", "cruise W"}, {}};
    for (const auto& group : groups)
        table.rows.push_back({group.selector, group.name.empty() ? "-" : clipped(group.name, max_name),
                              group.kind.empty() ? "-" : group.kind, cell_text(group.cells), power_text(group)});
    const auto text = to_text(table);
    const auto used = character_count(text.substr(0, text.find('\n'))) + 2;
    table.header.emplace_back("flights");
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto names = names_of(groups[g], flights);
        table.rows[g].push_back(clipped(fmt::format("{}: {}", names.size(), short_list(names)),
                                        std::max(min_flights, width - std::min(width, used))));
    }
    std::string notes;
    for (const auto& group : groups)
        if (!group.may_be.empty())
            notes += fmt::format("{}: of no certain aircraft, as nothing contradicts {}\n",
                                 short_list(names_of(group, flights)), fmt::join(group.may_be, " or "));
    return to_text(std::move(table)) + notes;
}

ShortIds short_ids(std::span<const AircraftGroup> groups) {
    ShortIds ids;
    for (const auto& group : groups) ids.emplace(group.id, short_id(group.id, groups));
    return ids;
}

std::string list_aircraft(std::span<const AircraftGroup> groups, std::span<const FlightAircraft> flights) {
    std::vector<std::string> lines;
    lines.reserve(groups.size());
    for (const auto& group : groups)
        lines.push_back(fmt::format("{}: {}", flight::describe_aircraft(short_id(group.id, groups), group.name),
                                    short_list(names_of(group, flights))));
    return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace flightwatt::batch
