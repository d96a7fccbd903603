#include "cli/output/watch_output.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WarningThrottle, AreSaidOnceAndAsTheyStandAtTheEnd) {
    WarningThrottle warnings;
    EXPECT_THAT(warnings.due({"1 gap, of 12 s"}), ElementsAre("1 gap, of 12 s"));
    EXPECT_THAT(warnings.due({"2 gaps, of 12.5 s", "no wind"}), ElementsAre("2 gaps, of 12.5 s", "no wind"));
    EXPECT_THAT(warnings.due({"3 gaps, of 40 s", "no wind"}), IsEmpty());
    EXPECT_THAT(warnings.final_updates({"3 gaps, of 40 s", "no wind"}), ElementsAre("3 gaps, of 40 s"));
    EXPECT_THAT(warnings.final_updates({"3 gaps, of 40 s", "no wind"}), IsEmpty());
}

TEST(WarningThrottle, AreBounded) {
    WarningThrottle warnings;
    std::size_t said = 0;
    for (int i = 0; i < 1000; ++i) said += warnings.due({std::string(static_cast<std::size_t>(i) + 1, 'x')}).size();
    EXPECT_EQ(said, WarningThrottle::max_kinds);
}

}  // namespace
}  // namespace flightwatt::cli
