#include "cli/said_warnings.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(SaidWarnings, AreSaidAgainWhenTheirNumbersHaveChangedMuch) {
    SaidWarnings warnings;
    EXPECT_THAT(warnings.to_say({"1 gap, of 12 s"}, 0.0), ElementsAre("1 gap, of 12 s"));
    EXPECT_THAT(warnings.to_say({"1 gap, of 12 s", "no wind"}, 1.0), ElementsAre("no wind"));
    EXPECT_THAT(warnings.to_say({"1 gap, of 40 s"}, 2.0), IsEmpty()) << "so soon";
    EXPECT_THAT(warnings.to_say({"1 gap, of 14 s"}, 40.0), IsEmpty()) << "so little";
    EXPECT_THAT(warnings.to_say({"1 gap, of 40 s"}, 50.0), ElementsAre("1 gap, of 40 s"));
    EXPECT_THAT(warnings.to_say({"1 gap, of 0 s"}, 90.0), ElementsAre("1 gap, of 0 s"));
}

/// A count that rises by one a second is said a handful of times, and as it stands at the end.
TEST(SaidWarnings, ACountIsSaidSeldomAndAtItsEnd) {
    SaidWarnings warnings;
    std::size_t said = 0;
    for (int i = 1; i <= 3000; ++i) said += warnings.to_say({fmt::format("{} lines are damaged", i)}, i).size();
    EXPECT_GE(said, 5U);
    EXPECT_LE(said, 8U);
    EXPECT_THAT(warnings.last_words({"3000 lines are damaged"}), ElementsAre("3000 lines are damaged"));
    EXPECT_THAT(warnings.last_words({"3000 lines are damaged"}), IsEmpty());
}

TEST(SaidWarnings, AreBounded) {
    SaidWarnings warnings;
    std::size_t said = 0;
    for (int i = 0; i < 1000; ++i)
        said += warnings.to_say({std::string(static_cast<std::size_t>(i) + 1, 'x')}, i).size();
    EXPECT_EQ(said, SaidWarnings::most_kinds);
}

}  // namespace
}  // namespace flightwatt::cli
