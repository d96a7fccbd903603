#pragma once

#include "flight/load_flight.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Which flights are of one aircraft.
namespace flightwatt::batch {

/// What a flight's log shows of its aircraft. Empty texts and values are unknown: they contradict nothing.
struct FlightAircraft {
    std::string flight = {};
    std::string id = {};
    std::string name = {};
    std::string kind = {};                      ///< of the firmware: "fixedwing", "rotorcraft", "rover"
    std::optional<double> pack_voltage_v = {};  ///< exceeded by 1 % of the log's samples
    std::optional<double> cruise_power_w = {};  ///< mean over all cruises or hovers
};

FlightAircraft aircraft_of(const flight::LoadedFlight& loaded);

/// Numbers of cells in series.
struct CellRange {
    int min = 1;
    int max = std::numeric_limits<int>::max();
    bool operator==(const CellRange&) const = default;
};

/// The numbers of lithium cells of a pack whose highest voltage in a log is this.
CellRange possible_cells(double pack_voltage_v);

/// The flights of one aircraft, and what they have in common.
struct AircraftGroup {
    std::string id = {};
    std::string name = {};
    std::string kind = {};
    CellRange cells = {};
    std::optional<double> min_power_w = {};  ///< of its flights' cruises
    std::optional<double> max_power_w = {};
    std::vector<std::size_t> flights = {};  ///< their numbers, rising
    std::string selector = {};              ///< a text for --aircraft that names this group alone
    std::vector<std::string> may_be = {};   ///< selectors of the groups to which these flights may belong; mostly empty
};

/// The flights by aircraft, in the order of their first flights. Two flights are of one aircraft if nothing contradicts
/// it: id, name, kind, cells, one being synthetic and, unless both state the same id, a power that differs by more than
/// a factor of 3. Flights that fit several groups are in a group of their own, with may_be.
std::vector<AircraftGroup> group_aircraft(std::span<const FlightAircraft> flights);

/// The group that --aircraft TEXT names: by id, else by a flight's name, the aircraft's name or the beginning of an id.
/// Throws UsageError, with a list of the groups, if it names none or several.
const AircraftGroup& find_aircraft(const std::string& text, std::span<const AircraftGroup> groups,
                                   std::span<const FlightAircraft> flights);

/// The groups as a table of at most `width` characters, and the flights that may be of several.
std::string aircraft_table(std::span<const AircraftGroup> groups, std::span<const FlightAircraft> flights,
                           std::size_t width);

/// By id: the shortest beginning that no other aircraft of the groups has, of 8 characters or more.
using ShortIds = std::map<std::string, std::string>;
ShortIds short_ids(std::span<const AircraftGroup> groups);

/// The groups in one line: "7 Opterra: a, b, c; 9 Twinstar: d".
std::string list_aircraft(std::span<const AircraftGroup> groups, std::span<const FlightAircraft> flights);

}  // namespace flightwatt::batch
