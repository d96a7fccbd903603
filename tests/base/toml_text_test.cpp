#include "base/text.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <toml++/toml.h>

namespace flightwatt {
namespace {

toml::table read_back(const std::string& value) { return toml::parse("value = " + value); }

TEST(TomlString, EscapesWhatAReaderWouldTakeForSomethingElse) {
    EXPECT_EQ(toml_string("plain"), "\"plain\"");
    EXPECT_EQ(toml_string("a\"b\\c"), R"("a\"b\\c")");
    EXPECT_EQ(toml_string("a\nb\x7F"), R"("a\u000Ab\u007F")");
}

TEST(TomlString, IsReadBack) {
    for (const std::string text : {"", "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x9A\x81", "tab\tline\n\"quoted\" \\"}) {
        EXPECT_EQ(read_back(toml_string(text))["value"].value<std::string>(), text);
    }
}

TEST(TomlString, ReplacesBytesThatAreNotUtf8) {
    const std::string replaced = "\xEF\xBF\xBD";
    EXPECT_EQ(toml_string("a\xFF"
                          "b"),
              "\"a" + replaced + "b\"");
    EXPECT_EQ(toml_string("\xC0\xAF"), "\"" + replaced + replaced + "\"") << "an overlong form";
    EXPECT_EQ(toml_string("\xE2\x82"), "\"" + replaced + "\"") << "a character that is cut off";
    EXPECT_EQ(toml_string("\xED\xA0\x80"), "\"" + replaced + replaced + replaced + "\"") << "a surrogate";
}

TEST(TomlString, StandsInAList) {
    EXPECT_EQ(toml_strings({}), "[]");
    EXPECT_EQ(toml_strings({"a", "b\"c"}), R"(["a", "b\"c"])");
}

TEST(TomlReal, IsTheShortestTextOfTheSameDouble) {
    EXPECT_EQ(toml_real(0.1), "0.1");
    EXPECT_EQ(toml_real(2.0), "2.0") << "an integer would be another type";
    EXPECT_EQ(toml_real(-0.0), "-0.0");
    EXPECT_EQ(toml_reals({}), "[]");
    EXPECT_EQ(toml_reals({1.0, 0.25}), "[1.0, 0.25]");
    for (const double value :
         {0.1, 1e300, 1e-300, 1.0 / 3.0, 9.9000000000000004, 1e22, std::numeric_limits<double>::denorm_min()}) {
        const auto read = read_back(toml_real(value));
        ASSERT_TRUE(read["value"].is_floating_point()) << toml_real(value);
        EXPECT_EQ(read["value"].value<double>(), value);
    }
}

}  // namespace
}  // namespace flightwatt
