#pragma once

#include "base/text_table.h"
#include "cli/stage.h"
#include "mission/disturbance.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"

#include <cstddef>
#include <optional>
#include <vector>

/// What simulate, compare and plan have in common: drawing flights, and their answers as JSON.
namespace flightwatt::cli {

/// Warns of what no drone has: negative power of the model or of a profile, a battery of another unit.
void warn_of_setup(const StageCall& call, const mission::MissionSetup& mission);

/// Which model says the power, where its file knows how it predicts.
void note_power_model(const StageCall& call, const mission::MissionSetup& mission);

/// If a mission that was written with another schedule has lost its comments.
void warn_of_lost_comments(const StageCall& call, const mission::PlannedMissionText& written);

/// What differs between flights and what does not, as "drawn" and "not_drawn".
void add_sources(const mission::UncertaintySources& sources, Json& json);

/// The summary as simulate and compare print it; null stands for "never".
Json to_json(const mission::MissionSummary& summary);

/// The same of missions in their order, with rank, "title" (the name with how the schedule came about) and
/// "chance_below_percent": what tables of missions show.
Json ranking_json(const std::vector<mission::MissionSummary>& ranked);

/// A row for each mission; cut-off, utility and the probability to land below the reserve have a column if any mission
/// has them.
TextTable comparison_table(const std::vector<mission::MissionSummary>& ranked);

/// rank,mission,schedule,... (docs/formats.md): a row a mission in their order, all columns whatever the missions are.
std::string comparison_csv(const std::vector<mission::MissionSummary>& ranked);

/// The same landing with the capacity that the flights of the pack indicate.
Json to_json(const mission::EstimatedLanding& landing);
inline constexpr auto by_flights_key =
    "with_capacity_of_flights";  ///< of that, where a mission's capacity contradicts it

/// A plan; null stands for what an infeasible one does not have.
Json to_json(const mission::MissionPlan& plan, const mission::MissionSetup& mission);

Json to_json(const mission::InfeasibilityReport& report);

}  // namespace flightwatt::cli
