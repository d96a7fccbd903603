#pragma once

#include "path/plan_files.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace flightwatt::path {

/// A flight plan of Paparazzi as XML.
struct FlightPlan {
    std::string file;
    std::vector<std::size_t> line_ends;  ///< offsets of the line ends in the file
    pugi::xml_document document;
    pugi::xml_node root;                             ///< <flight_plan> or <procedure>
    std::vector<pugi::xml_node> waypoints;           ///< in the order of their numbers
    std::multimap<std::string, std::size_t> number;  ///< numbers of the waypoints, by their names
    std::map<std::string, double> variables;         ///< values of <variables> that are numbers
};

/// Reads a flight plan. Throws InputError for a text that is not XML, or no flight plan.
FlightPlan load_flight_plan(std::string_view text, const std::string& file);

/// Returns an attribute, whose name may be in capitals (older plans); empty without it.
std::string attribute(const pugi::xml_node& node, const std::string& name);

/// Returns the place of a node in the file, for errors.
Location where(const FlightPlan& plan, const pugi::xml_node& node);

/// Returns the number of a waypoint, named with or without the prefix "WP_". Throws InputError at `asking` if none has
/// the name.
std::size_t waypoint_number(const FlightPlan& plan, std::string_view name, const Location& asking);

/// Returns lat0 and lon0. Throws InputError where they are no angles.
GeodeticPosition origin_of(const FlightPlan& plan);

/// Returns a waypoint as an entry: its place in metres from lat0 and lon0, and its altitude above the sea. Throws
/// InputError if it has no place.
PathEntry waypoint_entry(const FlightPlan& plan, std::size_t number);

/// Evaluates an expression with the plan's variables, ground_alt, GetAltRef(), flight_altitude and WaypointAlt(WP_...).
std::optional<double> evaluate(const FlightPlan& plan, std::string_view expression);

}  // namespace flightwatt::path
