#pragma once

#include "compute/processes/supervised_processes.h"

#include <cstdint>

/// The process between the profiler and the commands that it runs.
namespace flightwatt::compute {

/// What the supervisor tells through its pipe; smaller than PIPE_BUF, so written whole.
struct Event {
    enum class Kind : std::int32_t { not_started, ended, finished };
    Kind kind = Kind::ended;
    std::uint32_t command = 0;
    std::int32_t status = 0;  ///< errno, or of waitpid()
    std::int64_t time_ns = 0;
    EndReport report;  ///< of `finished`
};

/// Starts the commands, adopts what they fork, tells of each that ends, and on SIGTERM, or when `parent` is
/// gone, ends all of them. To be called in a forked process.
[[noreturn]] void supervise(const std::vector<std::vector<std::string>>& commands,
                            const SupervisedProcesses::Options& options, int events, ::pid_t parent);

}  // namespace flightwatt::compute
