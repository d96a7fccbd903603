#pragma once

#include <csignal>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt {

/// "SIGTERM"; "SIG?" for a number without a name.
std::string signal_name(int signal);

/// SIGINT, SIGTERM and SIGHUP, without those that the program was started to ignore (nohup).
std::vector<int> termination_signals();

/// While it lives, the ending signals do not end the program but wait here to be asked for: for programs of one thread
/// that have something to put in order first. Throws OutputError where the system has no more files.
class SignalWatch {
  public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// A file that poll() finds readable once a signal has come.
    int fd() const { return file_; }
    /// The signal that has come, if one has.
    std::optional<int> received() const;

  private:
    sigset_t before_{};
    int file_ = -1;
};

}  // namespace flightwatt
