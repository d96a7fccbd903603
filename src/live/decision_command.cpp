#include "live/decision_command.h"

#include "base/signal_watch.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <thread>
#include <utility>

#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/env.hpp>
#include <boost/process/environment.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/io.hpp>
#include <fmt/format.h>
#include <sys/wait.h>

namespace flightwatt::live {

void DecisionCommand::run(const Environment& variables) {
    if (child_ >= 0)
        pending_ = variables;
    else
        start(variables);
}

void DecisionCommand::start(const Environment& variables) {
    namespace bp = boost::process;
    bp::environment environment = boost::this_process::environment();
    for (const auto& [name, value] : variables) environment[name] = value;
    const auto reset_signals = [](auto& /*executor*/) {
        sigset_t none;
        ::sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
        for (const int ignored : {SIGPIPE, SIGXFSZ}) std::signal(ignored, SIG_DFL);  // by this program (cli/stage.cpp)
    };
    std::error_code error;
    bp::child process("/bin/sh", bp::args({"-c", command_}), environment, bp::std_in<bp::null, bp::std_out> stderr,
                      bp::extend::on_exec_setup(reset_signals), error);
    if (error)
        failure_ = fmt::format("cannot be run: {}", error.message());
    else
        child_ = process.id();
    process.detach();
}

std::optional<std::string> DecisionCommand::poll() {
    int status = 0;
    if (child_ >= 0 && ::waitpid(child_, &status, WNOHANG) == child_) {
        child_ = -1;
        if (WIFEXITED(status) && WEXITSTATUS(status) != 0) failure_ = fmt::format("exit code {}", WEXITSTATUS(status));
        if (WIFSIGNALED(status)) failure_ = "ended by " + signal_name(WTERMSIG(status));
        if (pending_) start(*std::exchange(pending_, std::nullopt));
    }
    if (failure_.empty()) return std::nullopt;
    return std::exchange(failure_, {});
}

bool DecisionCommand::wait(int max_ms) {
    constexpr int poll_ms = 10;
    for (int waited_ms = 0;; waited_ms += poll_ms) {
        failure_ = poll().value_or("");
        if (child_ < 0) return true;
        if (waited_ms >= max_ms) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(poll_ms));
    }
}

}  // namespace flightwatt::live
