#include "path/plans/flight_plan.h"

#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "path/plans/plan_expressions.h"

#include <algorithm>
#include <cmath>

#include <boost/algorithm/string/case_conv.hpp>
#include <fmt/format.h>

namespace flightwatt::path {
namespace {

std::size_t line_at(const FlightPlan& plan, std::ptrdiff_t offset) {
    if (offset < 0) return 0;
    const auto next = std::ranges::lower_bound(plan.line_ends, static_cast<std::size_t>(offset));
    return 1 + static_cast<std::size_t>(next - plan.line_ends.begin());
}

/// Decimal degrees, or "43 33 50.83": degrees, minutes and seconds.
double degrees(const FlightPlan& plan, const pugi::xml_node& node, const std::string& name) {
    const auto text = attribute(node, name);
    double value = 0.0;
    double unit = 1.0;
    for (const auto& word : split(text, " \t\n")) {
        value += std::abs(number_or_nan(word)) * unit;
        unit /= 60.0;
    }
    const bool is_angle = unit < 1.0 && value <= (name.starts_with("lat") ? 90.0 : 180.0);  // not NaN
    if (is_angle) return text.find('-') == std::string::npos ? value : -value;
    throw InputError(where(plan, node), fmt::format("{} of <{}> is no angle: '{}'", name, node.name(), text),
                     "expected decimal degrees, or degrees, minutes and seconds");
}

LocalPosition place_of(const FlightPlan& plan, const pugi::xml_node& waypoint) {
    const auto metres = [&](const char* name) {
        const auto text = attribute(waypoint, name);
        if (const auto value = parse_number(text)) return *value;
        throw InputError(where(plan, waypoint), fmt::format("{} of <waypoint> is no number: '{}'", name, text),
                         "expected metres");
    };
    if (!attribute(waypoint, "x").empty() && !attribute(waypoint, "y").empty()) return {metres("x"), metres("y")};
    if (!attribute(waypoint, "lat").empty() && !attribute(waypoint, "lon").empty()) {
        return to_local({degrees(plan, waypoint, "lat"), degrees(plan, waypoint, "lon")}, origin_of(plan));
    }
    throw InputError(where(plan, waypoint), fmt::format("waypoint {} has no place", attribute(waypoint, "name")),
                     "expected x and y, or lat and lon");
}

/// A name of the plan, other than WaypointAlt.
std::optional<double> named_value(const FlightPlan& plan, const std::string& name) {
    if (name == "ground_alt" || name == "GetAltRef()") return parse_number(attribute(plan.root, "ground_alt"));
    if (name == "flight_altitude") return parse_number(attribute(plan.root, "alt"));
    const auto variable = plan.variables.find(name);
    return variable == plan.variables.end() ? std::nullopt : std::optional(variable->second);
}

/// Above the sea: its own, its height above the plan's ground, or the plan's.
std::optional<double> altitude_of(const FlightPlan& plan, const pugi::xml_node& waypoint) {
    const auto value = [&](const std::string& expression) {
        return evaluate(expression, [&](const std::string& name) { return named_value(plan, name); });
    };
    if (const auto own = value(attribute(waypoint, "alt"))) return own;
    const auto height = value(attribute(waypoint, "height"));
    const auto ground = value("ground_alt");
    return height && ground ? std::optional(*ground + *height) : value("flight_altitude");
}

}  // namespace

GeodeticPosition origin_of(const FlightPlan& plan) {
    return {degrees(plan, plan.root, "lat0"), degrees(plan, plan.root, "lon0")};
}

std::string attribute(const pugi::xml_node& node, const std::string& name) {
    if (const auto found = node.attribute(name.c_str())) return found.value();
    return node.attribute(boost::algorithm::to_upper_copy(name).c_str()).value();
}

Location where(const FlightPlan& plan, const pugi::xml_node& node) {
    return {plan.file, line_at(plan, node.offset_debug())};
}

FlightPlan load_flight_plan(std::string_view text, const std::string& file) {
    FlightPlan plan;
    plan.file = file;
    for (auto at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
        plan.line_ends.push_back(at);
    const auto parsed = plan.document.load_buffer(text.data(), text.size());
    if (!parsed)
        throw InputError({file, line_at(plan, parsed.offset)}, fmt::format("is not XML: {}", parsed.description()));
    plan.root = plan.document.child("flight_plan");
    if (!plan.root) plan.root = plan.document.child("procedure");
    if (!plan.root)
        throw InputError({file}, "has no <flight_plan> and no <procedure>",
                         plan.document.child("kml") ? "a KML file is the area of a mission: in its [path] area = FILE, "
                                                      "spacing_m and heading_deg"
                                                    : "expected a flight plan of Paparazzi");
    for (const auto& waypoint : plan.root.child("waypoints").children("waypoint")) {
        plan.number.emplace(attribute(waypoint, "name"), plan.waypoints.size());
        plan.waypoints.push_back(waypoint);
    }
    for (const auto& variable : plan.root.child("variables").children("variable")) {
        if (const auto value = evaluate(plan, attribute(variable, "init")))
            plan.variables[attribute(variable, "var")] = *value;
    }
    return plan;
}

std::size_t waypoint_number(const FlightPlan& plan, std::string_view name, const Location& asking) {
    std::string sought(name);
    if (!plan.number.contains(sought) && sought.starts_with("WP_")) sought = sought.substr(3);
    const auto [found, end] = plan.number.equal_range(sought);
    if (found == end) {
        std::vector<std::string> names;
        for (const auto& waypoint : plan.waypoints) names.push_back(attribute(waypoint, "name"));
        throw InputError(asking, fmt::format("there is no waypoint '{}'", name),
                         names.empty() ? "the plan has no waypoints at all" : "the plan has " + short_list(names));
    }
    if (std::next(found) == end) return found->second;
    throw InputError(where(plan, plan.waypoints[found->second]),
                     fmt::format("there are several waypoints '{}'", sought), "give each a name of its own");
}

PathEntry waypoint_entry(const FlightPlan& plan, std::size_t number) {
    const auto& waypoint = plan.waypoints[number];
    PathEntry entry;
    entry.name = fmt::format("waypoint {}", attribute(waypoint, "name"));
    entry.where = where(plan, waypoint);
    entry.place = place_of(plan, waypoint);
    entry.altitude_m = altitude_of(plan, waypoint);
    constexpr double max_altitude_m = 1e5;
    if (entry.altitude_m)
        require_in(between(-max_altitude_m, max_altitude_m), *entry.altitude_m, "the altitude", entry.where);
    return entry;
}

std::optional<double> evaluate(const FlightPlan& plan, std::string_view expression) {
    return evaluate(expression, [&](const std::string& name) -> std::optional<double> {
        constexpr std::string_view altitude = "WaypointAlt(";
        if (!name.starts_with(altitude) || !name.ends_with(')')) return named_value(plan, name);
        const auto waypoint = name.substr(altitude.size(), name.size() - altitude.size() - 1);
        return altitude_of(plan, plan.waypoints[waypoint_number(plan, waypoint, {plan.file})]);
    });
}

}  // namespace flightwatt::path
