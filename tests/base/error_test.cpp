#include "base/error.h"

#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(Location, IsPrintedWithoutThePartsThatAreUnknown) {
    EXPECT_EQ(to_string(Location{"a.csv", 12, 7}), "a.csv:12:7");
    EXPECT_EQ(to_string(Location{"a.csv", 12, 0}), "a.csv:12");
    EXPECT_EQ(to_string(Location{"a.csv", 0, 7}), "a.csv") << "a column without a line states nothing";
    EXPECT_EQ(to_string(Location{}), "");
}

TEST(InputError, HoldsPlaceMessageAndHint) {
    const InputError error({"a.csv", 12, 7}, "power_w is not finite: 'nan'", "delete the row");
    EXPECT_STREQ(error.what(), "power_w is not finite: 'nan'");
    EXPECT_EQ(error.where().line, 12U);
    EXPECT_EQ(error.hint(), "delete the row");
    EXPECT_EQ(InputError({"a.csv"}, "is empty").hint(), "");
}

TEST(InputError, IsClippedWhateverAFilePutIntoIt) {
    const std::string long_key(50000, 'k');
    const std::string message = InputError({"a"}, "unknown key '" + long_key + "'", long_key).what();
    EXPECT_LT(message.size(), 2100U);
    EXPECT_TRUE(message.starts_with("unknown key 'kkk"));
    EXPECT_TRUE(message.ends_with("kkk'"));
    EXPECT_LT(InputError({"a"}, "x", long_key).hint().size(), 2100U);
    std::string umlauts;
    for (int i = 0; i < 3000; ++i) umlauts += "\xC3\xBC";
    const auto clipped_umlauts = truncated(umlauts);
    const auto gap = clipped_umlauts.find(" ... ");
    EXPECT_EQ(gap % 2, 0U) << "no character is cut in two";
    EXPECT_EQ((clipped_umlauts.size() - gap - 5) % 2, 0U);
    EXPECT_EQ(truncated("short"), "short");
}

TEST(ShortList, HasADozen) {
    EXPECT_EQ(short_list({}), "");
    EXPECT_EQ(short_list({"a", "b"}), "a, b");
    EXPECT_EQ(short_list(std::vector<std::string>(12, "x")), "x, x, x, x, x, x, x, x, x, x, x, x");
    EXPECT_EQ(short_list(std::vector<std::string>(40, "x")), "x, x, x, x, x, x, x, x, x, x, x, x ... and 28 more");
}

/// Each has an exit code of its own: catching one must not catch another.
TEST(Errors, AreNotOfOneAnother) {
    EXPECT_FALSE((std::is_base_of_v<InputError, UsageError> || std::is_base_of_v<UsageError, InputError>));
    EXPECT_FALSE((std::is_base_of_v<InputError, NoResultError> || std::is_base_of_v<NoResultError, InputError>));
    EXPECT_FALSE((std::is_base_of_v<OutputError, InputError> || std::is_base_of_v<InputError, OutputError>));
}

}  // namespace
}  // namespace flightwatt
