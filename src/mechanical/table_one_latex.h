#pragma once

#include "base/text_table.h"

#include <string>

namespace flightwatt::mechanical {

/// Table I as a LaTeX table environment like the paper's: its caption on top, coefficients as $a_0$ ...
/// $\xi$, numbers in mathematical mode, "+-" columns as half widths of 95 % intervals. Needs no package.
std::string to_latex(const TextTable& table);

}  // namespace flightwatt::mechanical
