#pragma once

#include "cli/output/json_document.h"
#include "mechanical/model_difference.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"

#include <optional>
#include <string>
#include <vector>

/// Output of diff.
namespace flightwatt::cli {

enum class DifferenceKind { models, batches, missions };

struct Differences {
    DifferenceKind kind = DifferenceKind::models;
    std::vector<mechanical::Difference> rows = {};
};

/// Energy of each phase, the quantities of the whole mission, and the largest difference of the states of charge.
/// Intervals are those of `drawn`.
std::vector<mechanical::Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b,
                                                       const std::optional<mission::SampledDifference>& drawn);

/// A row a quantity.
TextTable difference_table(const Differences& differences);
std::string differences_csv(const Differences& differences);

/// JSON of the stage.
Fields<Differences> record_fields(const Differences*);

/// Notes which quantities of two models differ: by more than flights do, and by more than the noise of their samples.
void note_differences(const StageCall& call, const std::vector<mechanical::Difference>& rows);

}  // namespace flightwatt::cli
