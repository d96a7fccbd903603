#include "report/figures/decimation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(VisibleRows, AreAllOfAShortLine) {
    const std::vector<double> time_s{0.0, 1.0, 5.0};
    EXPECT_EQ(visible_rows(time_s, {3.0, 1.0, 2.0}, 1), (std::vector<std::size_t>{0, 1, 2}));
}

/// Pixel columns look the same: each keeps its ends and extremes.
TEST(VisibleRows, KeepTheExtremesOfEveryColumn) {
    constexpr std::size_t columns = 10;
    std::vector<double> time_s;
    std::vector<double> values;
    for (int i = 0; i <= 1000; ++i) {
        time_s.push_back(i);
        values.push_back(std::sin(0.7 * i) * i);
    }
    const auto rows = visible_rows(time_s, values, columns);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    EXPECT_LE(rows.size(), 4 * columns);
    EXPECT_EQ(rows.front(), 0U);
    EXPECT_EQ(rows.back(), 1000U);
    const std::set<std::size_t> kept(rows.begin(), rows.end());
    for (std::size_t column = 0; column < columns; ++column) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(100 * column);
        const auto greatest = std::max_element(begin, begin + 100) - values.begin();
        const auto least = std::min_element(begin, begin + 100) - values.begin();
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(greatest))) << column;
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(least))) << column;
    }
}

}  // namespace
}  // namespace flightwatt::report
