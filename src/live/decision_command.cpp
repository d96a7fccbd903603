#include "live/decision_command.h"

#include "base/signal_watch.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

/// "NAME=value" of this program and `variables`, which count first.
std::vector<std::string> environment_with(const DecisionCommand::Environment& variables) {
    std::vector<std::string> entries;
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const std::string text = *entry;
        if (!variables.contains(text.substr(0, text.find('=')))) entries.push_back(text);
    }
    for (const auto& [name, value] : variables) entries.push_back(fmt::format("{}={}", name, value));
    return entries;
}

}  // namespace

void DecisionCommand::run(const Environment& variables) {
    if (child_ >= 0) {
        waiting_ = variables;
        return;
    }
    start(variables);
}

void DecisionCommand::start(const Environment& variables) {
    auto entries = environment_with(variables);
    std::vector<char*> environment;
    environment.reserve(entries.size() + 1);
    for (auto& entry : entries) environment.push_back(entry.data());
    environment.push_back(nullptr);
    std::array<std::string, 3> words{"sh", "-c", command_};
    std::array<char*, 4> arguments{words[0].data(), words[1].data(), words[2].data(), nullptr};
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t ignored;  // by this program (cli/stage.cpp)
    ::sigemptyset(&none);
    ::sigemptyset(&ignored);
    ::sigaddset(&ignored, SIGPIPE);
    ::sigaddset(&ignored, SIGXFSZ);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setsigdefault(&attributes, &ignored);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error = ::posix_spawn(&child_, "/bin/sh", &files, &attributes, arguments.data(), environment.data());
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&files);
    if (error == 0) return;
    child_ = -1;
    failure_ = fmt::format("cannot be run: {}", std::strerror(error));
}

std::optional<std::string> DecisionCommand::poll() {
    int status = 0;
    if (child_ >= 0 && ::waitpid(child_, &status, WNOHANG) == child_) {
        child_ = -1;
        if (WIFEXITED(status) && WEXITSTATUS(status) != 0) failure_ = fmt::format("exit code {}", WEXITSTATUS(status));
        if (WIFSIGNALED(status)) failure_ = "ended by " + signal_name(WTERMSIG(status));
        if (waiting_) start(*std::exchange(waiting_, std::nullopt));
    }
    if (failure_.empty()) return std::nullopt;
    return std::exchange(failure_, {});
}

bool DecisionCommand::wait(int max_ms) {
    constexpr int look_again_ms = 10;
    for (int waited_ms = 0; child_ >= 0; waited_ms += look_again_ms) {
        const auto failure = poll();
        if (failure) failure_ = *failure;
        if (child_ < 0) break;
        if (waited_ms >= max_ms) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(look_again_ms));
    }
    return true;
}

}  // namespace flightwatt::live
