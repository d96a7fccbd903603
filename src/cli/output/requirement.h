#pragma once

#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "mission/mission_summary.h"

#include <optional>
#include <string>
#include <vector>

/// What --require demands of missions, for tests of a CI.
namespace flightwatt::cli {

struct Requirement {
    std::optional<std::string> text;    ///< "reserve" or "reserve=0.95"; none: nothing is required
    std::optional<double> probability;  ///< of keeping the reserve; none: as modelled
};

/// --require. A probability draws flights, 10,000 unless --samples states another number.
void add_require_option(Options& options, Requirement& requirement, SamplingArguments& sampling);

/// Returns the reason why a mission misses what is required; std::nullopt where it does not. It is missed where a part
/// of the mission is uncertain. A probability is that of the drawn flights; without them, or where their variability is
/// unknown, it is missed.
std::optional<std::string> reason_missed(const Requirement& requirement, const mission::MissionSummary& summary);

/// Reports an error, and returns requirement_missed.
ExitCode report_missed(const StageCall& call, const std::string& reason);

/// Reports the missions that miss what is required as errors; returns requirement_missed, or ok.
ExitCode check_requirement(const StageCall& call, const Requirement& requirement,
                           const std::vector<mission::MissionSummary>& missions);

}  // namespace flightwatt::cli
