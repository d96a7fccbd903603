#pragma once

#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <filesystem>
#include <vector>

/// The runs of a profile and the files that they leave: layer 1, and runs.csv, by which an interrupted
/// profile is resumed.
namespace flightwatt::compute {

/// The runs in their order: idle first; then repeat by repeat, each in an order shuffled by the seed, so that
/// neither warming up nor a slow drift is taken for an effect of the configuration.
std::vector<ProfileRun> planned_runs(const ProfileSpecification& specification);

/// Makes sure that the results replace nothing but those of an earlier profile. Throws UsageError where the folder has
/// files of their names that no profile wrote, or where one of them is an input.
void check_result_files(const ProfileSpecification& specification, const std::vector<ProfileRun>& runs,
                        const std::filesystem::path& folder);

/// Marks the runs that an earlier call did with the same fingerprint, status ok, as done, with what they measured.
/// Others, also those that failed, are to be done again. A runs.csv that cannot be read counts as none.
void load_completed_runs(std::vector<ProfileRun>& runs, const std::filesystem::path& folder);

/// The files of a run: its layer 1 if it has power.
void write_layer1(const ProfileRun& run, const std::filesystem::path& folder);

/// runs.csv: a row a run that is done.
void write_runs(const std::vector<ProfileRun>& runs, const std::filesystem::path& folder);

}  // namespace flightwatt::compute
