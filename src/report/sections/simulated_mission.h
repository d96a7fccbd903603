#pragma once

#include "mission/feasibility_limits.h"
#include "mission/simulation.h"
#include "record/record.h"
#include "report/html.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// How a schedule that was planned stands to all others.
struct PlannedSchedule {
    bool feasible = false;        ///< it keeps the reserve
    double bound = 0.0;           ///< no schedule that keeps it has more utility; 0 if infeasible
    double margin_percent = 0.0;  ///< state of charge kept above the reserve
};

/// A mission with what came of it.
struct SimulatedMission {
    mission::Mission mission;
    mission::Simulation simulation;
    std::string title;  ///< the mission's name; " (2)" follows where another one has it
    std::optional<PlannedSchedule> planned = std::nullopt;  ///< of a mission that gave no schedule
};

/// Runs the missions, planned first where they are yet to be, with as many rows a curve as a screen shows. The curve of
/// a mission whose power the battery cannot deliver ends there. The report flies missions nowhere else.
std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::MissionVariant>& missions,
                                                  const Progress& progress = {});

/// The chance that "likely" means.
inline constexpr double reach_probability = 0.95;

/// What people ask of a mission, besides how it lands.
struct MissionAssessment {
    std::optional<mission::Reach> reach;  ///< as modelled
    std::optional<mission::Reach>
        reach_at_95_percent;            ///< with which `reach_probability` of the flights keep the reserve
    std::string no_reach;               ///< why there is none
    std::optional<double> capacity_ah;  ///< the least that would keep the reserve, if more than it has
    bool cruise_differs_now = false;    ///< between flights, and reach_at_95_percent is a length that is stated
    bool is_unplanned = false;          ///< reach and capacity are those of the schedule that demands least energy
};

/// Answers for a mission that was flown for the report; `mission_of` reads its file.
MissionAssessment assess_mission(const SimulatedMission& simulated, const mission::MissionLoader& mission_of);

/// Whether a mission keeps its reserve, as far as anybody knows.
enum class ReserveStatus {
    keeps,     ///< with a chance of 95 % or more, or as modelled where no chance is known
    may_keep,  ///< as modelled, but with a lesser chance, or not with the capacity that the pack's flights indicate
    fails
};

ReserveStatus verdict_of(const SimulatedMission& simulated);

/// What a card says, a line each: how the mission lands, its reserve, its reach, its utility, which model says its
/// power, and where it does not keep its reserve what would mend that.
std::vector<std::string> card_lines(const SimulatedMission& simulated, const MissionAssessment& answer);

/// JSON of a mission.
struct MissionOutput {
    const SimulatedMission* simulated = nullptr;
    const MissionAssessment* assessment = nullptr;
};
Fields<MissionOutput> record_fields(const MissionOutput*);

}  // namespace flightwatt::report
