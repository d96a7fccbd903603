#pragma once

#include "mission/feasibility_limits.h"
#include "mission/simulation.h"
#include "record/record.h"
#include "report/html.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A plan compared with all other schedules.
struct PlannedSchedule {
    bool feasible = false;  ///< it keeps the reserve
    double bound = 0.0;     ///< proven maximum utility of schedules that keep it; 0 if infeasible
};

/// A mission with its simulation.
struct SimulatedMission {
    mission::Mission mission;
    mission::Simulation simulation;
    std::string title;                                      ///< the mission's name, with " (2)" after an equal one
    std::optional<PlannedSchedule> planned = std::nullopt;  ///< of a mission without a schedule
};

/// Plans missions without a schedule and simulates all, with 300 rows a curve. A curve ends where the battery cannot
/// deliver the power.
std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::MissionVariant>& missions,
                                                  const Progress& progress = {});

/// Probability of a likely landing above the reserve.
inline constexpr double reach_probability = 0.95;

/// Reach of a mission, and the capacity that it needs.
struct MissionAssessment {
    std::optional<mission::Reach> reach;                ///< as modelled
    std::optional<mission::Reach> reach_at_95_percent;  ///< with reach_probability
    std::string no_reach_reason;
    std::optional<double> capacity_ah;  ///< minimum for the reserve, if more than it has
    bool is_unplanned = false;          ///< reach and capacity are of the schedule with the least energy
};

/// `mission_of` reads the mission's file.
MissionAssessment assess_mission(const SimulatedMission& simulated, const mission::MissionLoader& mission_of);

/// How a mission ends, the best first.
enum class Outcome {
    keeps,     ///< the reserve, with a probability of 95 % or more, or as modelled without a known one
    may_miss,  ///< as modelled it keeps it, but with less probability, or not with the capacity by the pack's flights
    misses,    ///< lands below the reserve as modelled
    fails,     ///< runs empty, is cut off, or asks for more power than the battery can deliver
};

/// Returns the probability of landing below the reserve; none where nothing shows how flights differ.
std::optional<double> known_probability_below_reserve(const mission::MissionSummary& summary);

Outcome outcome_of(const SimulatedMission& simulated);

/// Indices of the missions, the worst outcome first, then the least probable, then the lowest charge at landing.
std::vector<std::size_t> worst_first(std::span<const SimulatedMission> missions);

/// JSON of a mission.
struct MissionOutput {
    const SimulatedMission* simulated = nullptr;
    const MissionAssessment* assessment = nullptr;
};
Fields<MissionOutput> record_fields(const MissionOutput*);

}  // namespace flightwatt::report
