#pragma once

#include "cli/stage.h"
#include "mission/sampled_flights.h"

#include <optional>

/// What simulate and compare have in common about --samples.
namespace flightwatt::cli {

void add_sampling_options(StageDefinition& stage);

/// None without --samples. Throws UsageError for what is no whole number, or belongs to --samples and stands
/// without it.
std::optional<mission::SamplingOptions> sampling_options(const StageCall& call, bool with_bands);

}  // namespace flightwatt::cli
