#pragma once

#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <filesystem>
#include <vector>

/// Runs of a profile and their files: layer 1, and runs.csv, by which an interrupted profile is resumed.
namespace flightwatt::compute {

/// Runs in their order: idle, then repeat by repeat, each shuffled by the seed, so that configurations are not
/// confounded with warming up or a slow drift.
std::vector<ProfileRun> planned_runs(const ProfileSpecification& specification);

/// Throws UsageError where a result would replace an input, or a file that is not of an earlier profile.
void check_result_files(const ProfileSpecification& specification, const std::vector<ProfileRun>& runs,
                        const std::filesystem::path& folder);

/// Restores runs with the same fingerprint and status ok from an earlier call; a runs.csv that cannot be read is
/// ignored.
void load_completed_runs(std::vector<ProfileRun>& runs, const std::filesystem::path& folder);

/// Layer 1 of a run with power.
void write_layer1(const ProfileRun& run, const std::filesystem::path& folder);

/// runs.csv: a row for each finished run.
void write_runs(const std::vector<ProfileRun>& runs, const std::filesystem::path& folder);

}  // namespace flightwatt::compute
