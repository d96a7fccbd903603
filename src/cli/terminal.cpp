#include "cli/terminal.h"

#include "base/piecewise_linear.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

std::string_view value_of(const Environment& environment, const char* name) {
    const char* value = environment(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

/// The first of the three that is set decides, as in setlocale.
bool is_utf8(const Environment& environment) {
    for (const auto* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        std::string locale(value_of(environment, name));
        if (locale.empty()) continue;
        std::transform(locale.begin(), locale.end(), locale.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return locale.ends_with("utf-8") || locale.ends_with("utf8");
    }
    return false;
}

constexpr std::size_t dots_across = 2;  // of a braille character
constexpr std::size_t dots_down = 4;
constexpr std::size_t axis_columns = 7;   // "100.0 ┤"
constexpr std::size_t label_columns = 8;  // behind the area
constexpr std::size_t min_columns = 20;
/// Of the 256 colours those nearest to Okabe and Ito's, who chose them for the colour-blind.
constexpr std::array<int, 6> color_codes{33, 166, 36, 175, 214, 74};

/// The area, a character a cell, with the line that drew there last.
struct Canvas {
    std::size_t columns = 0;
    std::size_t rows = 0;
    double x_low = 0.0;
    double x_high = 0.0;
    std::vector<unsigned> dots = std::vector<unsigned>(columns * rows);
    std::vector<std::size_t> line = std::vector<std::size_t>(columns * rows);

    void set(std::size_t x, std::size_t y, std::size_t who) {
        // Unicode numbers the dots of a cell down its left column, then its right, and the lowest two last.
        constexpr std::array<std::array<unsigned, 4>, 2> bits{{{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
        const auto cell = y / dots_down * columns + x / dots_across;
        dots[cell] |= bits[x % dots_across][y % dots_down];
        line[cell] = who;
    }
};

/// Linear between points; std::nullopt outside.
std::optional<double> value_at(const TerminalLine& line, double x) {
    if (x < line.x.front() || x > line.x.back()) return std::nullopt;
    return interpolate_clamped(line.x, line.y, x);
}

std::size_t dot_row(const TerminalPlot& plot, const Canvas& canvas, double y) {
    const double part = std::clamp((plot.y_high - y) / (plot.y_high - plot.y_low), 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(part * static_cast<double>(canvas.rows * dots_down - 1)));
}

void draw_line(const TerminalPlot& plot, Canvas& canvas, const TerminalLine& line, std::size_t who) {
    const auto across = canvas.columns * dots_across;
    std::optional<double> last_y;
    for (std::size_t dot = 0; dot < across; ++dot) {
        const double part = static_cast<double>(dot) / static_cast<double>(across - 1);
        const double x = std::lerp(canvas.x_low, canvas.x_high, part);
        const auto y = value_at(line, x);
        if (y) {
            const auto [from, to] =
                std::minmax({dot_row(plot, canvas, *y), dot_row(plot, canvas, last_y.value_or(*y))});
            for (auto row = from; row <= to; ++row) canvas.set(dot, row, who);
        }
        last_y = y;
    }
}

/// The characters of braille stand in Unicode in the order of their dots.
std::string braille(unsigned dots) {
    const unsigned code = 0x2800U + dots;
    return {static_cast<char>(0xE0U | (code >> 12U)), static_cast<char>(0x80U | ((code >> 6U) & 0x3FU)),
            static_cast<char>(0x80U | (code & 0x3FU))};
}

std::string colored(const TerminalPlot& plot, const std::string& text, std::size_t who) {
    if (!plot.colors) return text;
    return fmt::format("\x1b[38;5;{}m{}\x1b[0m", color_codes[who % color_codes.size()], text);
}

/// One row of the area; neighbours of one line are coloured together.
std::string row_text(const TerminalPlot& plot, const Canvas& canvas, std::size_t row) {
    std::string text;
    for (std::size_t column = 0; column < canvas.columns;) {
        const auto cell = row * canvas.columns + column;
        std::string run;
        auto end = cell;
        const auto row_end = (row + 1) * canvas.columns;
        while (end < row_end && canvas.dots[end] != 0 && canvas.line[end] == canvas.line[cell]) {
            run += braille(canvas.dots[end++]);
        }
        text += run.empty() ? " " : colored(plot, run, canvas.line[cell]);
        column += std::max<std::size_t>(1, end - cell);
    }
    return text;
}

std::string axis_text(const TerminalPlot& plot, std::size_t row) {
    const bool is_marked = row == 0 || row + 1 == plot.rows || row == plot.rows / 2;
    if (!is_marked) return fmt::format("{:>{}}│", "", axis_columns - 1);
    const double part = static_cast<double>(row) / static_cast<double>(plot.rows - 1);
    return fmt::format("{:>{}.0f} ┤", std::lerp(plot.y_high, plot.y_low, part), axis_columns - 2);
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

/// "[###...] ", as wide as `width` if that is enough for a bar that tells anything.
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
    const bool is_able = is_terminal && !kind.empty() && kind != "dumb";
    ability.draws = is_able && is_utf8(environment);
    ability.colors = is_able && value_of(environment, "NO_COLOR").empty();
    return ability;
}

TerminalCapabilities standard_output_ability() { return ability_of(STDOUT_FILENO); }

bool standard_error_has_colors() { return ability_of(STDERR_FILENO).colors; }

std::FILE* standard_error_terminal() { return ::isatty(STDERR_FILENO) != 0 ? stderr : nullptr; }

std::string draw(const TerminalPlot& plot, std::span<const TerminalLine> lines) {
    if (lines.empty() || plot.rows < 2 || plot.columns < axis_columns + label_columns + min_columns) return "";
    double x_low = lines.front().x.front();
    double x_high = lines.front().x.back();
    for (const auto& line : lines) {
        x_low = std::min(x_low, line.x.front());
        x_high = std::max(x_high, line.x.back());
    }
    if (x_high <= x_low) return "";
    Canvas canvas{plot.columns - axis_columns - label_columns, plot.rows, x_low, x_high};
    std::vector<std::string> labels(plot.rows);
    std::vector<std::size_t> label_widths(plot.rows);
    for (std::size_t who = 0; who < lines.size(); ++who) {
        draw_line(plot, canvas, lines[who], who);
        if (lines[who].label.empty()) continue;
        const auto row = dot_row(plot, canvas, lines[who].y.back()) / dots_down;
        // As many as there is room for; " +" stands for more.
        const auto columns = label_widths[row] + 1 + lines[who].label.size();
        if (columns + 2 <= label_columns) labels[row] += " " + colored(plot, lines[who].label, who);
        if (columns + 2 > label_columns && label_widths[row] < label_columns) labels[row] += " +";
        label_widths[row] = columns + 2 <= label_columns ? columns : label_columns;
    }
    auto text = plot.title + "\n";
    for (std::size_t row = 0; row < plot.rows; ++row) {
        text += axis_text(plot, row);
        text += row_text(plot, canvas, row);
        text += labels[row] + "\n";
    }
    const auto end = fmt::format("{:.0f} {}", x_high, plot.x_label);
    const auto start = fmt::format("{:.0f}", x_low);
    const auto blanks = canvas.columns > start.size() + end.size() ? canvas.columns - start.size() - end.size() : 1;
    return text + fmt::format("{:>{}}{}{:>{}}{}\n", "", axis_columns, start, "", blanks, end);
}

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
    std::fwrite(text.data(), 1, text.size(), terminal_);  // a terminal that is gone changes nothing
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
