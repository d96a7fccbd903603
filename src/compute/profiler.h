#pragma once

#include "compute/power_sampler.h"
#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <filesystem>
#include <functional>

namespace flightwatt::compute {

struct ProfilerOptions {
    std::filesystem::path folder;  ///< of the results
    int signal_fd = -1;            ///< as in RunContext
    std::function<int()> caught;
    std::function<void(const PowerSampler&)> on_sampler_opened;  ///< called before the first run
    /// Called after each run with the number of finished runs.
    std::function<void(const ProfileRun&, std::size_t done, std::size_t all)> progress;
};

/// Runs what is not done yet, one run after the other; runs.csv and layer 1 are written after each. Throws UsageError
/// for a folder with files of other programs, Interrupted (a later call resumes), NoResultError without a sampler or
/// idle power, InputError of the sampler's files.
ProfileOutcome profile(const ProfileSpecification& specification, const ProfilerOptions& options);

}  // namespace flightwatt::compute
