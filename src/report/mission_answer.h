#pragma once

#include "mission/path_limits.h"
#include "report/simulated_mission.h"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace flightwatt::report {

/// The chance that "likely" means.
inline constexpr double likely = 0.95;

/// What people ask of a mission, besides how it lands.
struct MissionAnswer {
    std::optional<mission::Reach> reach;         ///< as modelled
    std::optional<mission::Reach> likely_reach;  ///< with which `likely` of the flights keep the reserve
    std::string no_reach;                        ///< why there is none
    std::optional<double> capacity_ah;           ///< the least that would keep the reserve, if more than it has
    bool cruise_differs_now = false;             ///< between flights, and likely_reach is a length that is stated
    bool is_unplanned = false;  ///< reach and capacity are those of the schedule that demands least energy
};

/// Answers for a mission that was flown for the report; `mission_of` reads its file.
MissionAnswer answer_for(const SimulatedMission& simulated, const mission::MissionOfReading& mission_of);

/// Whether a mission keeps its reserve, as far as anybody knows.
enum class Verdict {
    keeps,     ///< with a chance of 95 % or more, or as modelled where no chance is known
    may_keep,  ///< as modelled, but with a lesser chance, or not with the capacity that the pack's flights indicate
    fails
};

Verdict verdict_of(const SimulatedMission& simulated);

/// What a card says, a line each: how the mission lands, its reserve, its reach, its utility, which model says its
/// power, and where it does not keep its reserve what would mend that.
std::vector<std::string> card_lines(const SimulatedMission& simulated, const MissionAnswer& answer);

/// The same as JSON, in numbers.
nlohmann::ordered_json to_json(const SimulatedMission& simulated, const MissionAnswer& answer);

}  // namespace flightwatt::report
