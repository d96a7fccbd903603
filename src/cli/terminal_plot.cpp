#include "cli/terminal_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

constexpr std::size_t dots_across = 2;  // of a braille character
constexpr std::size_t dots_down = 4;
constexpr std::size_t axis_columns = 7;   // "100.0 ┤"
constexpr std::size_t label_columns = 8;  // behind the area
constexpr std::size_t least_columns = 20;
/// Of the 256 colours those nearest to Okabe and Ito's, who chose them for the colour-blind.
constexpr std::array<int, 6> color_codes{33, 166, 36, 175, 214, 74};

/// The area, a character a cell, with the line that drew there last.
struct Canvas {
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<unsigned> dots;
    std::vector<std::size_t> line;

    void set(std::size_t x, std::size_t y, std::size_t who) {
        // Unicode numbers the dots of a cell down its left column, then its right, and the lowest two last.
        constexpr std::array<std::array<unsigned, 4>, 2> bits{
            {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
        const auto cell = y / dots_down * columns + x / dots_across;
        dots[cell] |= bits[x % dots_across][y % dots_down];
        line[cell] = who;
    }
};

/// Linear between points; std::nullopt outside.
std::optional<double> value_at(const TerminalLine& line, double x) {
    if (x < line.x.front() || x > line.x.back()) return std::nullopt;
    const auto after = std::lower_bound(line.x.begin(), line.x.end(), x) - line.x.begin();
    const auto i = static_cast<std::size_t>(after);
    if (i == 0 || line.x[i] == line.x[i - 1]) return line.y[i];
    return std::lerp(line.y[i - 1], line.y[i], (x - line.x[i - 1]) / (line.x[i] - line.x[i - 1]));
}

std::size_t dot_row(const TerminalPlot& plot, const Canvas& canvas, double y) {
    const double part = std::clamp((plot.y_high - y) / (plot.y_high - plot.y_low), 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(part * static_cast<double>(canvas.rows * dots_down - 1)));
}

void draw_line(const TerminalPlot& plot, Canvas& canvas, const TerminalLine& line, std::size_t who,
               double x_low, double x_high) {
    const auto across = canvas.columns * dots_across;
    std::optional<std::size_t> last;
    for (std::size_t dot = 0; dot < across; ++dot) {
        const double x = std::lerp(x_low, x_high, static_cast<double>(dot) / static_cast<double>(across - 1));
        const auto y = value_at(line, x);
        if (!y) {
            last.reset();
            continue;
        }
        const auto row = dot_row(plot, canvas, *y);
        const auto from = std::min(row, last.value_or(row));
        const auto to = std::max(row, last.value_or(row));
        for (auto between = from; between <= to; ++between) canvas.set(dot, between, who);
        last = row;
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

}  // namespace

std::string draw(const TerminalPlot& plot, std::span<const TerminalLine> lines) {
    if (lines.empty() || plot.rows < 2 || plot.columns < axis_columns + label_columns + least_columns)
        return "";
    double x_low = lines.front().x.front();
    double x_high = lines.front().x.back();
    for (const auto& line : lines) {
        x_low = std::min(x_low, line.x.front());
        x_high = std::max(x_high, line.x.back());
    }
    if (x_high <= x_low) return "";
    Canvas canvas{plot.columns - axis_columns - label_columns, plot.rows, {}, {}};
    canvas.dots.assign(canvas.columns * canvas.rows, 0U);
    canvas.line.assign(canvas.columns * canvas.rows, 0U);
    std::vector<std::string> labels(plot.rows);
    for (std::size_t who = 0; who < lines.size(); ++who) {
        draw_line(plot, canvas, lines[who], who, x_low, x_high);
        auto& label = labels[dot_row(plot, canvas, lines[who].y.back()) / dots_down];
        if (!lines[who].label.empty()) label += " " + colored(plot, lines[who].label, who);
    }
    auto text = plot.title + "\n";
    for (std::size_t row = 0; row < plot.rows; ++row) {
        text += axis_text(plot, row);
        text += row_text(plot, canvas, row);
        text += labels[row] + "\n";
    }
    const auto end = fmt::format("{:.0f} {}", x_high, plot.x_label);
    const auto start = fmt::format("{:.0f}", x_low);
    const auto gap =
        canvas.columns > start.size() + end.size() ? canvas.columns - start.size() - end.size() : 1;
    return text + fmt::format("{:>{}}{}{:>{}}{}\n", "", axis_columns, start, "", gap, end);
}

}  // namespace flightwatt::cli
