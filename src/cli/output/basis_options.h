#pragma once

#include "cli/stage.h"
#include "live/prediction.h"
#include "mission/mission.h"

#include <optional>

/// What a flight in the air is predicted from, of predict and watch.
namespace flightwatt::cli {

/// Whether a mission has to say where it flies.
enum class PathNeed { required, optional };

/// --remaining, --level, --airspeed, --climb, --mission, --battery, --initial-soc; --model is the stage's own.
void add_basis_options(boost::program_options::options_description& options, PathNeed need);

/// What the options say, with warnings of the model or the mission. Without a path a mission's cruise takes as long as
/// it says. Where the path is optional, battery and state of charge are the mission's unless they are given. `mission`
/// becomes what --mission names. Throws UsageError for what does not fit together, and as live::require_spread and
/// live::require_physical.
live::PredictionInput read_basis(const StageCall& call, PathNeed need,
                                 std::optional<mission::MissionVariant>* mission = nullptr);

}  // namespace flightwatt::cli
