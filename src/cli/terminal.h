#pragma once

#include "cli/stage.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Small pictures below the tables of stages, where the standard output is a terminal that can show them.
namespace flightwatt::cli {

/// What the standard output can show.
struct TerminalCapabilities {
    bool is_terminal = false;
    bool draws = false;   ///< a terminal that shows Unicode
    bool colors = false;  ///< one that has colours, and they are wanted (no-color.org)
    std::size_t columns = 80;
};

/// The value of an environment variable, or nullptr.
using Environment = std::function<const char*(const char* name)>;

/// What a terminal of so many columns can show, after TERM (not "dumb"), the locale (LC_ALL, LC_CTYPE, LANG:
/// UTF-8) and NO_COLOR.
TerminalCapabilities detect_capabilities(bool is_terminal, std::size_t columns, const Environment& environment);

/// The same of the standard output of this program.
TerminalCapabilities standard_output_ability();

/// Whether diagnostics are read on a terminal with colours.
bool standard_error_has_colors();

/// A line of a plot in the terminal: `x` rises (equal values: a jump), `y` is as long; at least one point.
struct TerminalLine {
    std::vector<double> x;
    std::vector<double> y;
    std::string label;  ///< shown at its right end; may be empty
};

struct TerminalPlot {
    std::string title;
    std::string x_label;
    std::size_t columns = 80;  ///< of the whole plot, labels included
    std::size_t rows = 9;      ///< of its area
    bool colors = false;
    double y_low = 0.0;  ///< of the axis, less than y_high
    double y_high = 100.0;
};

/// A plot as wide as the terminal, or std::nullopt where the result goes elsewhere or the terminal cannot show it.
std::optional<TerminalPlot> terminal_plot(const StageCall& call, const std::string& title);

/// The lines drawn in braille characters (two by four dots each), with an axis at the left, the range of x
/// below, and each line's label where it ends. Empty where there is no room or nothing to draw.
std::string draw(const TerminalPlot& plot, std::span<const TerminalLine> lines);

}  // namespace flightwatt::cli
