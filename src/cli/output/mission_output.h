#pragma once

#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/packs.h"
#include "mission/plan.h"
#include "mission/planned_mission_toml.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::mechanical {
Fields<HeldOutScore> record_fields(const HeldOutScore*);
}

namespace flightwatt::path {
Fields<SurveyLayout> record_fields(const SurveyLayout*);
}

namespace flightwatt::mission {
Fields<UncertaintySources> record_fields(const UncertaintySources*);
Fields<EstimatedLanding> record_fields(const EstimatedLanding*);
Fields<MissionSummary> record_fields(const MissionSummary*);
Fields<FlownTrack> record_fields(const FlownTrack*);
Fields<PackFlight> record_fields(const PackFlight*);
Fields<PackFlights> record_fields(const PackFlights*);
}  // namespace flightwatt::mission

/// Options and JSON that simulate, compare and plan share.
namespace flightwatt::cli {

/// Warns of implausible inputs: negative power of the model or of a profile, a battery of another unit.
void warn_of_setup(const StageCall& call, const mission::MissionSetup& mission);

/// The names of the missions of one result.
class MissionNames {
  public:
    /// The mission, under a name of its own: with that of its file behind a name that another one has, with a note.
    mission::MissionVariant made_unique(const StageCall& call, mission::MissionVariant mission);

  private:
    std::set<std::string> used_;
};

/// Names the power model and its error, where its file has one.
void note_power_model(const StageCall& call, const mission::MissionSetup& mission);

/// The components that run, with their quality by parameter.
Keyed<Keyed<double>> run_values(const compute::Configuration& run, const compute::ComputeModel& compute);

/// Result and JSON of a mission over several packs. Throws NoResultError where they do not suffice.
void print_packs(const StageCall& call, const mission::PackFlights& all, const std::string& csv,
                 const ScreenTable& table);

/// Warns of a mission that was written without its comments.
void warn_of_lost_comments(const StageCall& call, const mission::PlannedMissionText& written);

/// A row of a comparison of missions.
struct RankedMission {
    std::size_t rank = 1;
    mission::MissionSummary summary;
};
Fields<RankedMission> record_fields(const RankedMission*);
std::vector<RankedMission> ranked_missions(const std::vector<mission::MissionSummary>& ranked);

/// JSON of compare.
struct MissionComparison {
    std::vector<RankedMission> missions;
};
Fields<MissionComparison> record_fields(const MissionComparison*);

/// JSON of plan.
struct PlanOutput {
    const mission::MissionPlan* plan = nullptr;
    const mission::MissionSetup* setup = nullptr;
    const mission::InfeasibilityReport* shortfall = nullptr;
};
Fields<PlanOutput> record_fields(const PlanOutput*);

}  // namespace flightwatt::cli
