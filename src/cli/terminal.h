#pragma once

#include "base/parallel.h"

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

/// Capabilities of the terminal, and progress on it.
namespace flightwatt::cli {

/// The width of the terminal that `stream` is; 80 where it is not known.
std::size_t terminal_columns(std::FILE* stream);

/// The text in lines of at most `columns`, cut between words; all but the first begin with `indentation`. A longer word
/// has a line of its own.
std::string wrapped(const std::string& text, std::size_t columns, std::string_view indentation = "  ");

/// The text with each paragraph wrapped to the terminal that `stream` is, without its first `margin` columns; elsewhere as
/// it is. Lines that begin with a blank stay.
std::string fitted(const std::string& text, std::FILE* stream, std::size_t margin = 0);

/// Whether what is printed there may have colours: a terminal, TERM not "dumb", and NO_COLOR not set (no-color.org).
bool is_coloured(std::FILE* stream);

/// Whether the standard output is a terminal whose screen can be rewritten: TERM is not "dumb".
bool standard_output_redraws();

/// From now on no progress is shown (--quiet).
void hide_progress();

/// The standard error, where progress is shown: on a terminal, or to a program that set FLIGHTWATT_PROGRESS and reads it.
std::FILE* standard_error_terminal();

/// Progress on a terminal, "512/1000 logs, 12 s left", drawn at most ten times a second. It draws nothing
/// where there is no terminal. May be called from several threads.
class ProgressBar {
  public:
    /// `unit` is what is counted, "logs"; `terminal` is an open terminal or nullptr.
    explicit ProgressBar(std::string unit, std::FILE* terminal = standard_error_terminal());
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::size_t done, std::size_t all);
    void hide();  ///< until show(), so that other text can be printed
    /// show(), for what takes a function; not longer than this lives.
    Progress callback();

  private:
    using Clock = std::chrono::steady_clock;

    std::mutex mutex_;  ///< guards what follows
    std::FILE* terminal_;
    std::string unit_;
    /// Of the last seconds: logs that are up to date go by faster than new ones.
    std::deque<std::pair<Clock::time_point, std::size_t>> recent_;
    std::size_t drawn_width_ = 0;

    void erase();
};

}  // namespace flightwatt::cli
