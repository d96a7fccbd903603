#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace flightwatt::cli {

/// What a progress bar shows.
struct ProgressState {
    std::size_t done = 0;
    std::size_t all = 0;
    double per_s = 0.0;  ///< how many are done a second; 0: not known yet
};

/// The state as one line of at most `width` characters: "[#####.....] 512/1000, 42.1 logs/s, 0:12 left". What
/// does not fit goes: the bar gets shorter, then rate and remaining time are not shown.
std::string progress_text(const ProgressState& state, const std::string& unit, std::size_t width);

/// A progress bar on a terminal, drawn at most ten times a second in the terminal's width. It draws nothing
/// once it is cleared. May be called from several threads.
class ProgressBar {
  public:
    /// `unit` is what is counted, "logs"; `terminal` is an open terminal.
    ProgressBar(std::FILE* terminal, std::string unit);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::size_t done, std::size_t all);
    void hide();  ///< until it is shown again: something else is to be told
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    struct Moment {
        Clock::time_point time;
        std::size_t done;
    };

    std::mutex mutex_;  ///< guards what follows
    std::FILE* terminal_;
    std::string unit_;
    std::deque<Moment> recent_;  ///< of the last seconds: logs that are up to date go by faster than new ones
    std::size_t drawn_width_ = 0;
    bool cleared_ = false;

    void erase();
};

/// A progress bar of what is done of `unit` where the standard error is a terminal, and nothing elsewhere; gone with
/// it.
class TerminalProgress {
  public:
    explicit TerminalProgress(const std::string& unit);
    void show(std::size_t done, std::size_t all);
    void hide();
    /// show(), for what takes a function; not longer than this lives.
    std::function<void(std::size_t done, std::size_t all)> callback();

  private:
    std::optional<ProgressBar> bar_;
};

}  // namespace flightwatt::cli
