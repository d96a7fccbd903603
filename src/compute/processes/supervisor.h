#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

/// The process between the profiler and the commands that it runs.
namespace flightwatt::compute {

struct SupervisionOptions {
    int output = -1;  ///< an open file for what the commands print
    int errors = -1;  ///< and for what they say
    std::chrono::milliseconds kill_timeout{2000};
};

/// What was found when the commands were ended.
struct ShutdownReport {
    std::size_t orphans = 0;    ///< processes that were alive beside the commands themselves
    bool killed = false;        ///< SIGTERM was not enough
    std::size_t survivors = 0;  ///< processes that not even SIGKILL ended
};

/// What the supervisor tells through its pipe; smaller than PIPE_BUF, so written whole.
struct SupervisorEvent {
    enum class Kind : std::int32_t { not_started, ended, finished };
    Kind kind = Kind::ended;
    std::uint32_t command = 0;
    std::int32_t status = 0;  ///< errno, or of waitpid()
    std::int64_t time_ns = 0;
    ShutdownReport report;  ///< of `finished`
};

/// Starts the commands, adopts what they fork, tells of each that ends, and on SIGTERM, or when `parent` is
/// gone, ends all of them. To be called in a forked process.
[[noreturn]] void supervise(const std::vector<std::vector<std::string>>& commands, const SupervisionOptions& options,
                            int events, ::pid_t parent);

}  // namespace flightwatt::compute
