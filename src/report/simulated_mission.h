#pragma once

#include "mission/simulation.h"

#include <string>
#include <vector>

namespace flightwatt {

/// A mission with what came of it.
struct SimulatedMission {
    Mission mission;
    Simulation simulation;
    std::string title;  ///< the mission's name; " (2)" follows where another one has it
};

/// Runs the missions, planned first where they are yet to be, with as many rows a curve as a screen shows.
/// The curve of a mission whose power the battery cannot deliver ends there.
std::vector<SimulatedMission> simulate_for_report(std::vector<Mission> missions);

/// What a configuration runs: "detection fps 10, encryption key_bits 240", or "nothing".
std::string describe(const ComputeModel& compute, const Configuration& run);

}  // namespace flightwatt
