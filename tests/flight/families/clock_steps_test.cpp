#include "flight/families/clock_steps.h"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;

/// Rows from the line 2 on.
std::optional<telemetry::SkippedLines> undo(std::vector<double>& time_s) {
    std::vector<std::size_t> lines(time_s.size());
    std::iota(lines.begin(), lines.end(), std::size_t{2});
    return undo_clock_steps(time_s, lines);
}

/// 50 rows a second, the clock of which is set back by so much at the row 20.
std::vector<double> set_back(double by_s) {
    std::vector<double> time_s;
    for (int i = 0; i < 50; ++i) time_s.push_back(i < 20 ? i : i - by_s);
    return time_s;
}

TEST(ClockSteps, KeepOrderAndIntervalsOfTheRows) {
    for (const double by_s : {2.0, 5.0, 9.0, 10.5}) {
        auto time_s = set_back(by_s);
        const auto found = undo(time_s);
        EXPECT_EQ(time_s, set_back(0.0)) << by_s;
        ASSERT_TRUE(found);
        EXPECT_EQ(found->lines.front().time_s, 20.0);
    }
    auto time_s = set_back(5.0);
    EXPECT_EQ(describe(*undo(time_s)),
              "the clock is set back by 5.0 s, first at 20.0 s: later times are that much later: "
              "1 line, first at line 22");
}

TEST(ClockSteps, AreNotLateRowsNorRecordings) {
    for (const auto& rows : std::vector<std::vector<double>>{set_back(12.0),
                                                             {0, 1, 2, 3, 5, 4, 6, 7},
                                                             {0, 1, 7, 8, 9, 2, 3, 4, 5, 6, 10, 11},
                                                             {0, 1, 2, 3, 3, 4, 4, 5},
                                                             {0, 0.7, 2, 1.7, 3, 2.7, 4, 3.7},
                                                             {0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 5, 6}}) {
        auto time_s = rows;
        EXPECT_FALSE(undo(time_s)) << testing::PrintToString(rows);
        EXPECT_EQ(time_s, rows);
    }
    std::vector<double> none;
    EXPECT_FALSE(undo(none));
}

TEST(ClockSteps, OfOneRecordingDoNotShiftTheNext) {
    std::vector<double> time_s{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 11, 12, 13, 14, 15, 0, 1, 2};
    EXPECT_TRUE(undo(time_s));
    EXPECT_THAT(time_s, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 0, 1, 2));
}

}  // namespace
}  // namespace flightwatt::flight
