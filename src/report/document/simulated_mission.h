#pragma once

#include "base/parallel.h"
#include "mission/feasibility_limits.h"
#include "mission/simulation.h"
#include "record/record.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A planned schedule compared with all other schedules.
struct PlannedSchedule {
    bool feasible = false;  ///< the plan keeps the reserve
    double bound = 0.0;     ///< proven maximum utility of schedules that keep it; 0 if infeasible
};

/// A mission with its simulation for the report.
struct SimulatedMission {
    mission::Mission mission;
    mission::Simulation simulation;
    std::string title;                                      ///< the mission's name, with " (2)" after an equal one
    std::optional<PlannedSchedule> planned = std::nullopt;  ///< plan of a mission without a schedule
    bool is_longest = false;  ///< the longest flight that keeps the reserve, as was asked: at the limit by construction
};

/// Plans the missions without a schedule and simulates all, with 300 points a curve. A curve ends when the battery
/// cannot deliver the power.
std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::MissionVariant>& missions,
                                                  const Progress& progress = {});

/// Probability of landing above the reserve that counts as likely.
inline constexpr double reach_probability = 0.95;

/// The reach of a mission, and the capacity that it needs.
struct MissionAssessment {
    std::optional<mission::Reach> reach;                ///< reach as modelled
    std::optional<mission::Reach> reach_at_95_percent;  ///< reach with reach_probability
    std::string no_reach_reason;                        ///< reason why there is no reach; empty if there is one
    std::optional<double> capacity_ah;                  ///< minimum for the reserve, if it is more than the mission's
    bool is_unplanned = false;  ///< reach and capacity are those of the schedule with the least energy
};

/// Computes reach and capacity of a mission; `mission_of` reads its file.
MissionAssessment assess_mission(const SimulatedMission& simulated, const mission::MissionLoader& mission_of);

/// The outcomes of a mission, the best first.
enum class Outcome {
    keeps,         ///< keeps the reserve with a probability of 95 % or more, or as modelled without a known one
    is_uncertain,  ///< the same, with a part that is not flown, that the aircraft may not be able to fly, or extrapolated
    may_miss,      ///< keeps it as modelled, but with less probability, or not with the capacity by the pack's flights
    misses,        ///< lands below the reserve as modelled
    fails,         ///< runs empty, is cut off, or asks for more power than the battery can deliver
};

/// Returns the probability of landing below the reserve; std::nullopt if the variability of flights is unknown.
std::optional<double> known_probability_below_reserve(const mission::MissionSummary& summary);

/// Returns the outcome of a mission.
Outcome outcome_of(const SimulatedMission& simulated);

/// Returns the indices of the missions: the worst outcome first, then the least probable, then the lowest charge at
/// landing.
std::vector<std::size_t> worst_first(std::span<const SimulatedMission> missions);

/// The parts of a mission's JSON.
struct MissionOutput {
    const SimulatedMission* simulated = nullptr;
    const MissionAssessment* assessment = nullptr;
};
Fields<MissionOutput> record_fields(const MissionOutput*);

}  // namespace flightwatt::report
