#pragma once

#include "compute/power_sampler.h"
#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace flightwatt::compute {

/// Power of one run of a configuration.
struct ComponentRun {
    RunStatus status = RunStatus::failed;
    std::string note;         ///< "exit code 3"
    PowerTrace trace;         ///< time since the start of the commands, from the end of the warm-up on
    double duration_s = 0.0;  ///< from the end of the warm-up to the end of the run
};

/// How much of the beginning and of the end of a run's output is kept.
inline constexpr std::size_t kept_output_bytes = 65536;

/// Whether the samples of a run came in few blocks, as of a program that does not flush each line: the first block was
/// measured in part before the run, and its end is missing.
bool come_in_bursts(std::size_t samples, std::size_t arrivals);

/// Sampler, output and signals of a run.
struct RunContext {
    PowerSampler* sampler = nullptr;
    double interval_s = 0.1;               ///< of polling a sensor
    std::filesystem::path output;          ///< of the commands, both ends of it; none if they print nothing
    int signals = -1;                      ///< readable after a signal to end (SignalWatch)
    std::function<int()> received_signal;  ///< the signal
    double kill_timeout_s = 2.0;           ///< between SIGTERM and SIGKILL
    std::filesystem::path folder = {};     ///< where the commands run
};

/// Runs the commands and samples power for the duration (until the first sample, if that comes later), or until the
/// first of them ends; then ends their processes. No
/// commands: the idle computer. The status reports commands that fail. Throws Interrupted, NoResultError for a process that
/// cannot be ended, and as the sampler; the processes are then ended too.
ComponentRun run_component(const std::vector<std::vector<std::string>>& commands, const ProfileTiming& timing,
                           const RunContext& frame);

/// The same from a recording: its samples after the warm-up, within the duration. Each sample counts for the mean
/// interval, a single one for `interval_s`.
ComponentRun run_of_recording(const PowerTrace& recording, const ProfileTiming& timing, double interval_s);

}  // namespace flightwatt::compute
