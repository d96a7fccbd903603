#include "report/figures/decimation.h"

#include <algorithm>
#include <numeric>

namespace flightwatt::report {

std::vector<std::size_t> visible_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                                      std::size_t columns) {
    constexpr std::size_t rows_per_column = 4;
    std::vector<std::size_t> rows(time_s.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (rows.size() <= rows_per_column * columns) return rows;
    const double span_s = time_s.back() - time_s.front();
    const auto column_of = [&](std::size_t i) {
        const double part = (time_s[i] - time_s.front()) / span_s;
        return std::min(columns - 1, static_cast<std::size_t>(part * static_cast<double>(columns)));
    };
    std::vector<std::size_t> kept;
    for (std::size_t first = 0; first < rows.size();) {
        std::size_t end = first;
        while (end < rows.size() && column_of(end) == column_of(first)) ++end;
        const auto begin_row = rows.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end_row = rows.begin() + static_cast<std::ptrdiff_t>(end);
        const auto [least, greatest] = std::minmax_element(
            begin_row, end_row, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
        std::vector<std::size_t> chosen{first, *least, *greatest, end - 1};
        std::sort(chosen.begin(), chosen.end());
        chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
        kept.insert(kept.end(), chosen.begin(), chosen.end());
        first = end;
    }
    return kept;
}

}  // namespace flightwatt::report
