#include "base/toml_reader.h"

#include "base/toml_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(TomlReader, ReadsTypedValuesInTheOrderOfTheFile) {
    const auto root = parse_toml("b = 2\na = 1.5\nname = \"x\"\nlist = [1, 2.5]\n[t]\nflag = true\n", "m.toml");
    EXPECT_EQ(root.number("b"), 2.0);
    EXPECT_EQ(root.number("a"), 1.5);
    EXPECT_EQ(root.string("name"), "x");
    EXPECT_THAT(root.numbers("list"), ElementsAre(1.0, 2.5));
    EXPECT_EQ(root.table("t").optional_boolean("flag"), true);
    EXPECT_THAT(root.keys(), ElementsAre("b", "a", "name", "list", "t"));
    EXPECT_NO_THROW(root.refuse_unknown_keys());
}

template <typename Use>
void expect_error(const std::string& text, std::size_t line, const std::string& message, const std::string& hint,
                  Use&& use) {
    try {
        use(parse_toml(text, "m.toml"));
        FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().file, "m.toml");
        EXPECT_EQ(error.where().line, line) << error.what();
        EXPECT_THAT(error.what(), HasSubstr(message));
        EXPECT_THAT(error.hint(), HasSubstr(hint));
    }
}

TEST(TomlReader, RefusesWithFileAndLine) {
    const auto power = [](const TomlTable& root) {
        root.number("power_w");
        root.refuse_unknown_keys();
    };
    expect_error("power_w = ", 1, "is not TOML", "", power);
    expect_error("\npower_w = \"5\"", 2, "expected a finite number", "", power);
    expect_error("power_w = nan", 1, "expected a finite number", "", power);
    expect_error("power_w = 1\npower_kw = 2", 2, "unknown key 'power_kw'", "did you mean 'power_w'?", power);
    expect_error("power_w = 1\nelephant = 2", 2, "unknown key 'elephant'", "known keys: power_w", power);
    expect_error("x = 1\npower_kw = 2", 2, "has no key 'power_w'", "'power_kw' is here", power);
}

TEST(TomlText, ReadsBackExactly) {
    const std::string odd = "quote \" backslash \\ tab \t end";
    const auto root = parse_toml("s = " + toml_string(odd) + "\nx = " + toml_real(0.1) + "\ny = " + toml_real(28.0) +
                                     "\nz = " + toml_reals({1.0, 1e-300}),
                                 "m.toml");
    EXPECT_EQ(root.string("s"), odd);
    EXPECT_EQ(root.number("x"), 0.1);
    EXPECT_EQ(root.number("y"), 28.0);
    EXPECT_THAT(root.numbers("z"), ElementsAre(1.0, 1e-300));
}

TEST(TomlText, ReplacesWhatIsNotUtf8) {
    EXPECT_EQ(toml_string("Ünal \xF0\x9F\x9B\xA9"), "\"Ünal \xF0\x9F\x9B\xA9\"");
    for (const auto* bad : {"\xFF", "\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82"}) {
        const auto root = parse_toml("s = " + toml_string(std::string("a") + bad), "m.toml");
        EXPECT_THAT(root.string("s"), HasSubstr("\xEF\xBF\xBD")) << toml_string(bad);
    }
}

TEST(NearestWord, FindsMisspellingsAndNothingElse) {
    EXPECT_EQ(nearest_word("landng", {"takeoff", "cruise", "landing"}), "landing");
    EXPECT_EQ(nearest_word("elephant", {"takeoff", "cruise", "landing"}), "");
}

}  // namespace
}  // namespace flightwatt
