#pragma once

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::test {

/// How many living processes have `marker` on their command line.
inline int processes_with(const std::string& marker) {
    int count = 0;
    std::error_code gone;
    for (std::filesystem::directory_iterator it("/proc", gone), end; it != end; it.increment(gone)) {
        std::ifstream file(it->path() / "cmdline");
        const std::string line((std::istreambuf_iterator<char>(file)), {});
        if (line.find(marker) != std::string::npos) ++count;
    }
    return count;
}

/// A marker that no other process has: a long sleep of its own length.
inline std::string new_marker() {
    static int next = 0;
    return fmt::format("9{:07}.{}", ::getpid(), ++next);
}

inline bool wait_until(const std::function<bool()>& condition) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

/// Starts a program of ours in `folder`; what it prints goes to the files stdout and stderr there.
inline ::pid_t start_program(const std::string& name, const std::vector<std::string>& arguments,
                             const std::filesystem::path& folder) {
    const auto child = ::fork();
    if (child != 0) return child;
    const auto file = [&](const char* path) {
        return ::open((folder / path).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    };
    ::dup2(file("stdout"), STDOUT_FILENO);
    ::dup2(file("stderr"), STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0) ::_exit(98);
    const auto program = binary_dir() / "bin" / name;
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), name);
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    ::_exit(99);
}

inline int exit_code_of(::pid_t child) {
    int status = -1;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

inline int run_program(const std::string& name, const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder) {
    return exit_code_of(start_program(name, arguments, folder));
}

}  // namespace flightwatt::test
