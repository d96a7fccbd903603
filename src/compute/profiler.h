#pragma once

#include "compute/profile_interpolation.h"
#include "compute/profile_specification.h"
#include "compute/profiling/profile_runs.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A configuration and its power.
struct NodeEstimate {
    std::vector<double> qos;
    PowerEstimate total;      ///< interpolated: power and standard error alone
    bool is_measured = true;  ///< false: interpolated from the others
};

/// The power of a component over its configurations: layer 2.
struct ComponentEstimate {
    std::string name;
    std::vector<std::string> parameters;
    std::vector<NodeEstimate> nodes;  ///< without those that failed
    std::size_t configurations = 0;
    std::vector<ProfileRun> failures;                ///< runs without power
    std::optional<LeaveOneOutErrors> interpolation;  ///< of the method that was used, on the measured nodes
};

struct ProfileOutcome {
    std::string sampler;  ///< kind and source
    std::optional<PowerEstimate> idle;
    std::vector<ComponentEstimate> components;
    std::vector<ProfileRun> runs;
    SamplingJitter jitter;
};

struct ProfilerOptions {
    std::filesystem::path folder;       ///< of the results
    std::optional<std::size_t> trials;  ///< configurations of each component to run; absent: all
    int signal_fd = -1;                 ///< as in RunContext
    std::function<int()> caught;
    std::function<void(const PowerSampler&)> on_sampler_opened;  ///< called before the first run
    /// Called after each run with how many are done.
    std::function<void(const ProfileRun&, std::size_t done, std::size_t all)> progress;
};

/// Profiles: runs what is not done yet, one run after the other, keeping runs.csv and layer 1 in the folder up to
/// date after each. Throws UsageError for trials too few to interpolate from, Interrupted (the folder then tells
/// how far it came), NoResultError where there is no sampler or the idle computer could not be measured,
/// InputError of the sampler's files.
ProfileOutcome profile(const ProfileSpecification& specification, const ProfilerOptions& options);

}  // namespace flightwatt::compute
