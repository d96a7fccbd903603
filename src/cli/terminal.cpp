#include "cli/terminal.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

bool progress_is_hidden = false;

std::string_view value_of(const Environment& environment, const char* name) {
    const char* value = environment(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

constexpr auto min_interval = std::chrono::milliseconds(100);
constexpr auto rate_window = std::chrono::seconds(10);

/// "0:07", "12:34", "3:05:09".
std::string clock_text(double time_s) {
    constexpr double max_s = 359999.0;  // 99:59:59
    const std::chrono::seconds whole(static_cast<long>(std::ceil(std::min(time_s, max_s))));
    const std::chrono::hh_mm_ss clock(whole);
    const auto [hours, minutes, s] =
        std::tuple(clock.hours().count(), clock.minutes().count(), clock.seconds().count());
    return hours == 0 ? fmt::format("{}:{:02}", minutes, s) : fmt::format("{}:{:02}:{:02}", hours, minutes, s);
}

std::string rate_text(const ProgressState& state, const std::string& unit) {
    if (!(state.per_s > 0.0)) return "";
    const auto left_s = static_cast<double>(state.all - std::min(state.done, state.all)) / state.per_s;
    return fmt::format(", {:.{}f} {}/s, {} left", state.per_s, state.per_s < 100.0 ? 1 : 0, unit, clock_text(left_s));
}

/// "[###...] ", as wide as `width` if that is enough for a readable bar.
std::string bar_text(const ProgressState& state, std::size_t width) {
    constexpr std::size_t frame = 3;  // brackets and a blank
    constexpr std::size_t least = 5;
    constexpr std::size_t most = 40;
    if (width < frame + least || state.all == 0) return "";
    const auto cells = std::min(width - frame, most);
    const auto full = cells * std::min(state.done, state.all) / state.all;
    return "[" + std::string(full, '#') + std::string(cells - full, '.') + "] ";
}

/// 0: not known.
std::size_t columns_of(int terminal) {
    winsize size{};
    return ::ioctl(terminal, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

TerminalCapabilities ability_of(int stream) {
    return detect_capabilities(::isatty(stream) != 0, columns_of(stream),
                               [](const char* name) { return std::getenv(name); });
}

}  // namespace

TerminalCapabilities detect_capabilities(bool is_terminal, std::size_t columns, const Environment& environment) {
    TerminalCapabilities ability;
    if (columns > 0) ability.columns = columns;
    const auto kind = value_of(environment, "TERM");
    ability.is_terminal = is_terminal;
    ability.redraws = is_terminal && !kind.empty() && kind != "dumb";
    ability.colors = ability.redraws && value_of(environment, "NO_COLOR").empty();
    return ability;
}

TerminalCapabilities standard_output_ability() { return ability_of(STDOUT_FILENO); }

bool standard_error_has_colors() { return ability_of(STDERR_FILENO).colors; }

void hide_progress() { progress_is_hidden = true; }

std::FILE* standard_error_terminal() { return !progress_is_hidden && ::isatty(STDERR_FILENO) != 0 ? stderr : nullptr; }

std::string progress_text(const ProgressState& state, const std::string& unit, std::size_t width) {
    auto text = fmt::format("{}/{}", state.done, state.all);
    const auto rate = rate_text(state, unit);
    if (text.size() + rate.size() <= width) text += rate;
    if (text.size() > width) return "";
    return bar_text(state, width - text.size()) + text;
}

ProgressBar::ProgressBar(std::string unit, std::FILE* terminal)
    : terminal_(terminal), unit_(std::move(unit)), recent_{{Clock::now(), 0}} {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(std::size_t done, std::size_t all) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (terminal_ == nullptr || cleared_ || now - recent_.back().time < min_interval) return;
    recent_.push_back({now, done});
    while (recent_.size() > 2 && now - recent_.front().time > rate_window) recent_.pop_front();
    const std::chrono::duration<double> window = now - recent_.front().time;
    const auto per_s = static_cast<double>(done - recent_.front().done) / window.count();
    const auto columns = columns_of(::fileno(terminal_));
    // One column less: a full last one makes some terminals wrap.
    const auto text =
        progress_text({done, all, per_s}, unit_, (columns > 0 ? columns : TerminalCapabilities().columns) - 1);
    erase();
    std::fwrite(text.data(), 1, text.size(), terminal_);  // a closed terminal is ignored
    std::fflush(terminal_);
    drawn_width_ = text.size();
}

void ProgressBar::hide() {
    const std::lock_guard lock(mutex_);
    erase();
}

void ProgressBar::clear() {
    const std::lock_guard lock(mutex_);
    erase();
    cleared_ = true;
}

/// With blanks: every terminal knows them.
void ProgressBar::erase() {
    if (drawn_width_ > 0) {
        const auto blanks = fmt::format("\r{}\r", std::string(drawn_width_, ' '));
        std::fwrite(blanks.data(), 1, blanks.size(), terminal_);
        std::fflush(terminal_);
    }
    drawn_width_ = 0;
}

std::function<void(std::size_t, std::size_t)> ProgressBar::callback() {
    return [this](std::size_t done, std::size_t all) { show(done, all); };
}

}  // namespace flightwatt::cli
