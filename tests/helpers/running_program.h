#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace flightwatt::test {

/// What a program printed and returned.
struct ProgramResult {
    int code = -1;  ///< exit code; -1: ended by a signal
    std::string out;
    std::string err;
};

/// Runs a command of sh in `folder`, with the programs of this build on the PATH and nothing to read. Nothing is
/// written into the folder but what the command writes. `environment`: "NAME=value ...", put before the PATH.
ProgramResult run_shell(const std::string& command, const std::filesystem::path& folder,
                        const std::string& environment = "LC_ALL=C");

/// A path as one word of sh.
std::string shell_quoted(const std::filesystem::path& path);

/// Starts a program of this build in `folder`; what it prints goes to the files stdout and stderr there.
::pid_t start_program(const std::string& name, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder);

/// Waits for the end; the status of waitpid().
int wait_status_of(::pid_t child);

/// Waits for the end; -1 where a signal ended it.
int exit_code_of(::pid_t child);

/// start_program() to its end.
int run_program(const std::string& name, const std::vector<std::string>& arguments,
                const std::filesystem::path& folder);

/// How many living processes have `marker` on their command line.
int processes_with(const std::string& marker);

/// A marker that no other process has: a long sleep of its own length.
std::string new_marker();

/// Looks every 10 ms; false if it does not hold within five minutes: a sanitized run on a busy machine takes one.
bool wait_until(const std::function<bool()>& condition);

}  // namespace flightwatt::test
