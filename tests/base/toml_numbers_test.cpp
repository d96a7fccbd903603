#include "base/toml_numbers.h"

#include "helpers/rejected.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

const auto table = parse_toml("minus = -1\nzero = 0\nhalf = 0.5\nthree = 3\nhuge = 1e300\n", "m.toml");

template <typename Read>
std::string message(const Read& read) {
    return test::rejected(read);
}

TEST(TomlNumbers, ReadsWhatIsInTheRange) {
    EXPECT_EQ(number_in(at_least(0.0), table, "zero"), 0.0);
    EXPECT_EQ(number_in(more_than(0.0), table, "half"), 0.5);
    EXPECT_EQ(number_in(between(-1.0, 0.0), table, "minus"), -1.0);
    EXPECT_EQ(number_in(more_than_up_to(0.0, 3.0), table, "three"), 3.0);
    EXPECT_EQ(optional_number_in(at_least(0.0), table, "none"), std::nullopt);
    EXPECT_EQ(number_in_or(at_least(0.0), table, "none", 7.0), 7.0);
    EXPECT_EQ(number_in_or(at_least(0.0), table, "three", 7.0), 3.0);
    EXPECT_EQ(count_in(table, "three", 3), 3U);
    EXPECT_EQ(count_in_or(table, "none", 2, 5), 5U);
}

TEST(TomlNumbers, SaysWhatIsExpectedWhereTheKeyStands) {
    EXPECT_EQ(message([] { number_in(at_least(0.0), table, "minus"); }), "m.toml:1:1: minus = -1, expected 0 or more");
    EXPECT_EQ(message([] { number_in(more_than(0.0), table, "zero", "as of a scale"); }),
              "m.toml:2:1: zero = 0, expected more than 0; as of a scale");
    EXPECT_EQ(message([] { optional_number_in(between(0.0, 1.0), table, "three"); }),
              "m.toml:4:1: three = 3, expected 0 to 1");
    EXPECT_EQ(message([] { number_in_or(more_than_up_to(0.0, 1.0), table, "zero", 1.0); }),
              "m.toml:2:1: zero = 0, expected more than 0 and at most 1");
    EXPECT_EQ(message([] { number_in(at_most(1.0), table, "three"); }), "m.toml:4:1: three = 3, expected at most 1");
    EXPECT_EQ(message([] { count_in(table, "half"); }), "m.toml:3:1: half = 0.5, expected a whole number");
    EXPECT_EQ(message([] { count_in(table, "minus"); }), "m.toml:1:1: minus = -1, expected a whole number, 0 or more");
    EXPECT_EQ(message([] { count_in_or(table, "three", 4, 9); }),
              "m.toml:4:1: three = 3, expected a whole number, 4 or more");
    EXPECT_EQ(message([] { count_in(table, "huge"); }), "m.toml:5:1: huge = 1e+300, expected a whole number");
}

TEST(TomlNumbers, NotANumberIsInNoRange) {
    EXPECT_EQ(message([] { require_in(at_least(0.0), std::nan(""), "x", {"f"}); }), "f: x = nan, expected 0 or more");
}

}  // namespace
}  // namespace flightwatt
