#pragma once

#include "mechanical/mechanical_model.h"
#include "mission/packs.h"
#include "mission/replay.h"
#include "report/html.h"
#include "report/sections/simulated_mission.h"

#include <span>
#include <vector>

namespace flightwatt::report {

/// Returns the sections of missions: each mechanical model that is not in `shown` and each software once, schedules as
/// Fig. 3 with the ranking, maps over the quality of service as Fig. 4. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// Returns the section of missions over several packs: a row for each flight.
Section packs_section(std::span<const mission::PackFlights> missions);

/// Returns the section of the missions' schedules on the flights' measured power. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

}  // namespace flightwatt::report
