#pragma once

#include "compute/power_sampler.h"
#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <filesystem>
#include <string>

namespace flightwatt::compute {

/// The power of a configuration while it ran once.
struct ComponentRun {
    RunStatus status = RunStatus::failed;
    std::string note;         ///< "exit code 3", "left 2 processes behind, ended"
    PowerTrace trace;         ///< time since the start of the commands, from the end of the warm-up on
    double duration_s = 0.0;  ///< from the end of the warm-up to the end of the run
};

/// How a run is done.
struct RunContext {
    PowerSampler* sampler = nullptr;
    double interval_s = 0.1;               ///< between questions to a sensor
    std::filesystem::path output;          ///< what the commands print and say goes there; removed if nothing does
    int signals = -1;                      ///< a file that is readable once the program is to end (SignalWatch)
    std::function<int()> received_signal;  ///< the signal then
    double kill_timeout_s = 2.0;           ///< between SIGTERM and SIGKILL
};

/// Runs the commands, samples power until the duration is over, or without one until the first of them ends,
/// and ends everything that is left of them, whatever it did. A command that fails is no error of this
/// function: the status tells. No commands: the idle computer, for the duration. Throws Interrupted, and what
/// the sampler throws; nothing runs on then either.
ComponentRun run_component(const std::vector<std::vector<std::string>>& commands, const ProfileTiming& timing,
                           const RunContext& frame);

/// The same from a recording: the samples after the warm-up, of the duration if there is one. Each sample
/// stands for the mean interval, a single one for `interval_s`.
ComponentRun run_of_recording(const PowerTrace& recording, const ProfileTiming& timing, double interval_s);

}  // namespace flightwatt::compute
