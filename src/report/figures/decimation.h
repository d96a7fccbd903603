#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt::report {

/// The rows of a line that a screen of so many pixel columns can tell from all rows: of each column the
/// first, the last, the least and the greatest value (M4: Jugel et al., VLDB 2014). Indices, rising. All of
/// them where there are no more than four a column.
std::vector<std::size_t> visible_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                                      std::size_t columns);

}  // namespace flightwatt::report
