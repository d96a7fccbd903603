#pragma once

#include <csignal>
#include <optional>

namespace flightwatt {

/// While it lives, SIGINT, SIGTERM and SIGHUP do not end the program but wait here to be asked for: for
/// programs of one thread that have something to put in order first. Signals that the program was started to
/// ignore (nohup) stay ignored. Throws OutputError where the system has no more files.
class SignalWatch {
  public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// A file that poll() finds readable once a signal has come.
    int file() const { return file_; }
    /// The signal that has come, if one has.
    std::optional<int> caught() const;

  private:
    sigset_t before_{};
    int file_ = -1;
};

}  // namespace flightwatt
