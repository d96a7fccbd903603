#pragma once

#include "base/text_table.h"
#include "mission/replay.h"
#include "report/figure.h"
#include "report/html.h"
#include "report/simulated_mission.h"

#include <optional>
#include <span>
#include <vector>

namespace flightwatt::report {

/// The missions ranked by final state of charge, under their titles.
TextTable ranking_table(std::span<const SimulatedMission> missions);

/// Those whose schedules were planned, with the proven bound; without rows where none was.
TextTable plans_table(std::span<const SimulatedMission> missions);

/// The missions' mechanical models and profiled software, each once, the model of the flights that the page shows
/// already (`shown`, one a folder) not again; their schedules as Fig. 3 with the ranking; and the map over the quality
/// of service as Fig. 4 of each flight and software with two parameters or more. `missions` is not empty.
std::vector<Section> mission_sections(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                                      std::span<const mechanical::MechanicalModel> shown = {});

/// The missions whose schedules were planned: their utility and what is proven of it, beside the other missions with
/// the same flight, software and battery, and what runs when. Without figures where none was planned.
Section plan_section(std::span<const SimulatedMission> missions);

/// What the missions' schedules came to on the flights' measured power: tables, sentences, and a figure a mission that
/// is yet to be planned. `replays` is not empty.
Section replay_section(std::span<const mission::Replay> replays);

/// Its tables.
std::vector<CaptionedTable> replay_tables(std::span<const mission::Replay> replays);

}  // namespace flightwatt::report
