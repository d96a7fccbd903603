#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::cli {

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

/// The lines drawn in braille characters (two by four dots each), with an axis at the left, the range of x
/// below, and each line's label where it ends. Empty where there is no room or nothing to draw.
std::string draw(const TerminalPlot& plot, std::span<const TerminalLine> lines);

}  // namespace flightwatt::cli
