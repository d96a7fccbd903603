#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

/// Capabilities of the terminal, and progress bars on it.
namespace flightwatt::cli {

/// Capabilities of the standard output.
struct TerminalCapabilities {
    bool is_terminal = false;
    bool redraws = false;  ///< a terminal whose screen can be rewritten
    bool colors = false;   ///< one that has colours, and they are wanted (no-color.org)
    std::size_t columns = 80;
};

/// The value of an environment variable, or nullptr.
using Environment = std::function<const char*(const char* name)>;

/// Capabilities of a terminal with `columns`, from TERM (not "dumb") and NO_COLOR.
TerminalCapabilities detect_capabilities(bool is_terminal, std::size_t columns, const Environment& environment);

/// The same of the standard output of this program.
TerminalCapabilities standard_output_ability();

/// Whether diagnostics are read on a terminal with colours.
bool standard_error_has_colors();

/// Numbers of a progress bar.
struct ProgressState {
    std::size_t done = 0;
    std::size_t all = 0;
    double per_s = 0.0;  ///< how many are done a second; 0: not known yet
};

/// The state as one line of at most `width` characters: "[#####.....] 512/1000, 42.1 logs/s, 0:12 left". What
/// does not fit goes: the bar gets shorter, then rate and remaining time are not shown.
std::string progress_text(const ProgressState& state, const std::string& unit, std::size_t width);

/// From now on no progress is shown (--quiet).
void hide_progress();

/// The standard error, where it is a terminal and progress is shown.
std::FILE* standard_error_terminal();

/// A progress bar on a terminal, drawn at most ten times a second in the terminal's width. It draws nothing
/// once it is cleared, and where there is no terminal. May be called from several threads.
class ProgressBar {
  public:
    /// `unit` is what is counted, "logs"; `terminal` is an open terminal or nullptr.
    explicit ProgressBar(std::string unit, std::FILE* terminal = standard_error_terminal());
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::size_t done, std::size_t all);
    void hide();  ///< until show(), so that other text can be printed
    void clear();
    /// show(), for what takes a function; not longer than this lives.
    std::function<void(std::size_t done, std::size_t all)> callback();

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

}  // namespace flightwatt::cli
