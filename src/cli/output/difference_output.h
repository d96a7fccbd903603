#pragma once

#include "cli/stage.h"
#include "mechanical/model_difference.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {
Fields<Difference> record_fields(const Difference*);
}

/// Output of diff.
namespace flightwatt::cli {

enum class DifferenceKind { models, batches, missions };

struct Differences {
    DifferenceKind kind = DifferenceKind::models;
    std::vector<mechanical::Difference> rows = {};
};

/// Energy of each phase and the quantities of the whole mission. Intervals are those of `drawn`.
std::vector<mechanical::Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b,
                                                       const std::optional<mission::SampledDifference>& drawn);

/// JSON of the stage.
Fields<Differences> record_fields(const Differences*);

/// Notes which quantities of two models differ: by more than flights do, and by more than the noise of their samples.
void note_differences(const StageCall& call, const std::vector<mechanical::Difference>& rows);

}  // namespace flightwatt::cli
