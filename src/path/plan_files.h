#pragma once

#include "path/path_entries.h"
#include "path/plan_fence.h"
#include "path/turns.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::path {

/// Values that a plan leaves to the autopilot's settings.
struct AutopilotSettings {
    std::optional<double> radius_m;  ///< radius of circles for which the plan states none
    /// Airspeed for circles that end after a time; 0: the plan's own, without which they are flown once.
    double airspeed_m_per_s = 0.0;
    bool is_rotorcraft = false;          ///< of plans that name no kind of vehicle
    bool one_airspeed = false;           ///< the plan's changes of the airspeed are not flown
    std::filesystem::path terrain = {};  ///< folder of tiles, for altitudes above the terrain; empty: none
    Wind wind = {};                      ///< in which circles that end after a time are flown
    TurnLimits turns = {};               ///< how narrow such circles are
    std::optional<GeodeticPosition> home = std::nullopt;  ///< where it takes off, instead of the plan's home
    bool returns_to_start = false;                        ///< its end is followed by a straight way there
};

/// The airspeed that a plan states for all legs without one of their own.
struct PlannedSpeed {
    double m_per_s = 0.0;
    std::string source;       ///< "the plan's hoverSpeed"
    bool is_default = false;  ///< what QGroundControl writes where it was never set
};

/// The movements of a plan, in the order of the flight.
struct PlanEntries {
    std::vector<PathEntry> entries;
    std::vector<std::string> not_flown = {};  ///< "line 80: the circle around STDBY has no end: it is flown once"
    std::vector<std::string> missing = {};    ///< those of `not_flown` that leave out a movement, of unknown energy
    bool starts_at_first_place = false;       ///< see PathDefaults
    bool starts_at_home = false;              ///< the first entry is the plan's home
    bool is_above_home = false;               ///< altitudes are above home
    bool ends_with_landing = false;
    std::optional<PlannedSpeed> speed = {};
    std::optional<bool> is_of_multirotor = {};  ///< by the kind of vehicle that the plan names; else of a wing
    bool is_of_vtol = false;                    ///< by that kind, or as it takes off or lands as a VTOL
    PlanFence fence = {};
    std::optional<double> home_altitude_m = {};  ///< of home above the sea, where altitudes are above home
    bool is_above_sea = false;                   ///< altitudes are above the sea, and the height of home is not stated
};

/// A block of a flight plan, read alone; or the whole mission of a plan in another format.
struct PlanBlock {
    std::string name;
    std::size_t line = 0;    ///< 0: unknown
    std::string flown = {};  ///< summary of what is flown: "5 legs, 1.5 circles"; empty if nothing is
    double length_m = 0.0;
    std::vector<std::string> not_flown = {};
};

}  // namespace flightwatt::path
