#include "cli/output/watch_output.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WarningThrottle, AreSaidAgainWhenTheirNumbersHaveChangedMuch) {
    WarningThrottle warnings;
    EXPECT_THAT(warnings.due({"1 gap, of 12 s"}, 0.0), ElementsAre("1 gap, of 12 s"));
    EXPECT_THAT(warnings.due({"1 gap, of 12 s", "no wind"}, 1.0), ElementsAre("no wind"));
    EXPECT_THAT(warnings.due({"1 gap, of 40 s"}, 2.0), IsEmpty()) << "so soon";
    EXPECT_THAT(warnings.due({"1 gap, of 14 s"}, 40.0), IsEmpty()) << "so little";
    EXPECT_THAT(warnings.due({"1 gap, of 40 s"}, 50.0), ElementsAre("1 gap, of 40 s"));
    EXPECT_THAT(warnings.due({"1 gap, of 0 s"}, 90.0), ElementsAre("1 gap, of 0 s"));
}

/// A count that rises by one a second is said a handful of times, and as it stands at the end.
TEST(WarningThrottle, ACountIsSaidSeldomAndAtItsEnd) {
    WarningThrottle warnings;
    std::size_t said = 0;
    for (int i = 1; i <= 3000; ++i) said += warnings.due({fmt::format("{} lines are damaged", i)}, i).size();
    EXPECT_GE(said, 5U);
    EXPECT_LE(said, 8U);
    EXPECT_THAT(warnings.final_updates({"3000 lines are damaged"}), ElementsAre("3000 lines are damaged"));
    EXPECT_THAT(warnings.final_updates({"3000 lines are damaged"}), IsEmpty());
}

TEST(WarningThrottle, AreBounded) {
    WarningThrottle warnings;
    std::size_t said = 0;
    for (int i = 0; i < 1000; ++i) said += warnings.due({std::string(static_cast<std::size_t>(i) + 1, 'x')}, i).size();
    EXPECT_EQ(said, WarningThrottle::max_kinds);
}

}  // namespace
}  // namespace flightwatt::cli
