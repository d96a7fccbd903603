#include "base/format_version.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

std::string refusal(const std::string& text) {
    return test::rejected([&] { require_known_format(parse_toml(text, "m.toml")); });
}

TEST(FormatVersion, IsOptionalAndKnown) {
    EXPECT_EQ(refusal(""), "");
    EXPECT_EQ(refusal(format_line()), "");
    const auto root = parse_toml(format_line(), "m.toml");
    require_known_format(root);
    EXPECT_NO_THROW(root.refuse_unknown_keys());
}

TEST(FormatVersion, RefusesNewerOnesAndNonsense) {
    EXPECT_EQ(refusal("format = 2"),
              "m.toml:1:1: format = 2 is newer than this program, which reads formats up to 1; use a newer "
              "FlightWatt, or write the file with this one");
    EXPECT_NE(refusal("format = 0").find("expected a whole number from 1 to 1"), std::string::npos);
    EXPECT_NE(refusal("format = 0.5").find("is no version"), std::string::npos);
    EXPECT_NE(refusal("format = \"1\"").find("m.toml:1:1"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt
