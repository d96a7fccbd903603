#pragma once

#include "mission/simulation.h"
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

/// What a configuration runs: "detection fps 10, encryption key_bits 240", or "nothing".
std::string describe(const compute::ComputeModel& compute, const compute::Configuration& run);

}  // namespace flightwatt::report
