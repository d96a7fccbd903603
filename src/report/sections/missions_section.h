#pragma once

#include "mechanical/mechanical_model.h"
#include "mission/packs.h"
#include "mission/replay.h"
#include "report/html.h"
#include "report/sections/simulated_mission.h"

#include <span>
#include <vector>

namespace flightwatt::report {

/// Each mechanical model that is not in `shown` and each software once, schedules as Fig. 3 with the ranking, maps over
/// the quality of service as Fig. 4. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// Missions over several packs: a row for each flight.
Section packs_section(std::span<const mission::PackFlights> missions);

/// Schedules of missions on the flights' measured power. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

}  // namespace flightwatt::report
