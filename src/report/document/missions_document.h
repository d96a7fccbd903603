#pragma once

#include "mission/packs.h"
#include "mission/replay.h"
#include "report/document/findings.h"
#include "report/latex_tables.h"

#include <span>
#include <string>
#include <vector>

/// Missions of a document (web/app/src/documents.ts).
namespace flightwatt::report {

/// Returns "One of nine missions runs empty, two land below the reserve"; empty without missions.
std::string missions_headline(const Findings& findings);

/// Returns all missions (MissionDocument), in their order, and adds the table of their ranking. There is at least one.
Json missions_json(const Findings& findings, LatexTables& tables);

/// Returns what energies and probabilities of missions are (ScheduleNotes).
Json schedule_notes(std::span<const SimulatedMission> missions);

/// Returns the profiled power of each software (SoftwareProfile).
Json software_json(std::span<const SimulatedMission> missions);

/// Returns a grid over the quality of service for each flight (QualityGrid), with the map of Fig. 4 if figures are
/// wanted.
Json quality_json(std::span<const SimulatedMission> missions, bool with_figures);

/// Returns the models of missions that are not in `shown`.
std::vector<mechanical::MechanicalModel> other_models(std::span<const SimulatedMission> missions,
                                                      std::span<const mechanical::MechanicalModel> shown);

/// Returns missions over several packs (PackMission).
Json packs_json(std::span<const mission::PackFlights> missions, LatexTables& tables);

/// Returns the missions' schedules on the flights' measured power (ReplayDocument). `replays` is not empty.
Json replay_json(std::span<const mission::Replay> replays, LatexTables& tables);

}  // namespace flightwatt::report
