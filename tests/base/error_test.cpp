#include "base/error.h"

#include <type_traits>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(Location, IsPrintedWithoutThePartsThatAreUnknown) {
    EXPECT_EQ(to_string(Location{"a.csv", 12, 7}), "a.csv:12:7");
    EXPECT_EQ(to_string(Location{"a.csv", 12, 0}), "a.csv:12");
    EXPECT_EQ(to_string(Location{"a.csv", 0, 7}), "a.csv") << "a column without a line says nothing";
    EXPECT_EQ(to_string(Location{}), "");
}

TEST(InputError, HoldsPlaceMessageAndHint) {
    const InputError error({"a.csv", 12, 7}, "power_w is not finite: 'nan'", "delete the row");
    EXPECT_STREQ(error.what(), "power_w is not finite: 'nan'");
    EXPECT_EQ(error.where().line, 12U);
    EXPECT_EQ(error.hint(), "delete the row");
    EXPECT_EQ(InputError({"a.csv"}, "is empty").hint(), "");
}

/// Each has an exit code of its own: catching one must not catch another.
TEST(Errors, AreNotOfOneAnother) {
    EXPECT_FALSE((std::is_base_of_v<InputError, UsageError> || std::is_base_of_v<UsageError, InputError>));
    EXPECT_FALSE((std::is_base_of_v<InputError, NoAnswerError> || std::is_base_of_v<NoAnswerError, InputError>));
    EXPECT_FALSE((std::is_base_of_v<OutputError, InputError> || std::is_base_of_v<InputError, OutputError>));
}

}  // namespace
}  // namespace flightwatt
