#pragma once

#include "base/text_table.h"
#include "cli/stage.h"
#include "mechanical/model_difference.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What diff compares and shows.
namespace flightwatt::cli {

enum class DifferenceKind { models, batches, missions };

struct Differences {
    DifferenceKind kind = DifferenceKind::models;
    std::vector<mechanical::Difference> rows = {};
    std::vector<std::string> shared_flights = {};  ///< that both models rest on
};

/// Energy of each phase, then the quantities of the whole mission, and where the states of charge are furthest apart.
/// They are computed and have intervals only as `drawn`.
std::vector<mechanical::Difference> mission_difference(const mission::Simulation& a, const mission::Simulation& b,
                                                       const std::optional<mission::SampledDifference>& drawn);

/// A row a quantity, its numbers of the form that fmt knows by this text; empty: all digits.
TextTable difference_table(const Differences& differences, std::string_view form);

Json to_json(const Differences& differences);

/// Notes which quantities of two models differ: by more than flights do, and by more than the noise of their samples.
void note_differences(const StageCall& call, const std::vector<mechanical::Difference>& rows);

}  // namespace flightwatt::cli
