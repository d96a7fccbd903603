#include "base/toml_reader.h"

#include "base/text.h"
#include "helpers/rejected.h"

#include <cmath>
#include <string>
#include <vector>

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

std::string repeated(const std::string& text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

std::string refusal_of(const std::string& text) {
    return test::rejected([&] { parse_toml(text, "m.toml"); });
}

/// The parser would end the program at some ten thousand levels: its stack.
TEST(TomlReader, RefusesWhatNestsTooDeep) {
    const std::string deeper = "nested more than 50 levels deep";
    constexpr std::size_t levels = 60000;
    EXPECT_EQ(refusal_of("x = 1\na" + repeated(".a", levels) + " = 1"), "m.toml:2:102: keys are " + deeper);
    const std::vector<std::string> texts{
        "[a" + repeated(".a", levels) + "]\n",
        "[[a" + repeated(". \"b\"", levels) + "]]\n",
        "'q'" + repeated(".'q'", levels) + " = 1",
    };
    for (const auto& text : texts) EXPECT_THAT(refusal_of(text), HasSubstr(deeper)) << text.substr(0, 60);
    for (const auto* const opened : {"[", "[\n#]\n", "{ a = ", "{ a.b.c = ["})
        EXPECT_THAT(refusal_of("x = " + repeated(opened, levels)), HasSubstr("exceeded maximum nested value depth"));
}

TEST(TomlReader, CountsNoDepthInStringsAndComments) {
    const auto many = repeated("[{.", 100);
    const auto text = "a = \"" + many + "\"\nb = '" + many + "'\nc = \"\"\"\n" + many + "\n\"\"\"\nd = '''" + many +
                      "''' # " + many + "\ne = [" + repeated("[1.5, 2.5], ", 1000) + "]\n\"" + many + "\" = 1\n";
    EXPECT_EQ(refusal_of(text), "");
    EXPECT_EQ(parse_toml(text, "m.toml").string("a"), many);
}

TEST(TomlReader, RefusesMoreThanAnyMissionHolds) {
    EXPECT_EQ(refusal_of(repeated("# comment\n", 800001)),
              "m.toml: holds more than 8 MB of TOML; is it the file that was meant?");
}

TEST(TomlReader, ClipsWhatItQuotes) {
    const auto root = parse_toml("power_w = 1\n" + std::string(100000, 'k') + " = 1", "m.toml");
    root.number("power_w");
    EXPECT_LT(test::rejected([&] { root.refuse_unknown_keys(); }).size(), 3000U);
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
    EXPECT_EQ(nearest_word("off", {"is_off_s", "off_duration_s", "offset"}), "offset");
}

TEST(NearestWord, IsTheHintWhereThereIsOne) {
    EXPECT_EQ(meant_or("landng", {"takeoff", "landing"}, "see --help"), "did you mean 'landing'?");
    EXPECT_EQ(meant_or("elephant", {"takeoff", "landing"}, "see --help"), "see --help");
    EXPECT_EQ(meant_or("airspeed_m_s", {"airspeed_m_per_s"}, ""), "did you mean 'airspeed_m_per_s'?") << "m/s, too";
    EXPECT_EQ(meant_or("ground_speed_ms", {"ground_speed_m_per_s"}, ""), "did you mean 'ground_speed_m_per_s'?");
    EXPECT_EQ(meant_or("airspeed_km_h", {"airspeed_m_per_s"}, "none"), "none");
}

const auto numbers = parse_toml("minus = -1\nzero = 0\nhalf = 0.5\nthree = 3\nhuge = 1e300\n", "m.toml");

template <typename Read>
std::string message(const Read& read) {
    return test::rejected(read);
}

TEST(TomlNumbers, ReadsWhatIsInTheRange) {
    EXPECT_EQ(number_in(at_least(0.0), numbers, "zero"), 0.0);
    EXPECT_EQ(number_in(more_than(0.0), numbers, "half"), 0.5);
    EXPECT_EQ(number_in(between(-1.0, 0.0), numbers, "minus"), -1.0);
    EXPECT_EQ(number_in(more_than_up_to(0.0, 3.0), numbers, "three"), 3.0);
    EXPECT_EQ(optional_number_in(at_least(0.0), numbers, "none"), std::nullopt);
    EXPECT_EQ(number_in_or(at_least(0.0), numbers, "none", 7.0), 7.0);
    EXPECT_EQ(number_in_or(at_least(0.0), numbers, "three", 7.0), 3.0);
    EXPECT_EQ(count_in(numbers, "three", 3), 3U);
    EXPECT_EQ(count_in_or(numbers, "none", 2, 5), 5U);
}

TEST(TomlNumbers, SaysWhatIsExpectedWhereTheKeyStands) {
    EXPECT_EQ(message([] { number_in(at_least(0.0), numbers, "minus"); }),
              "m.toml:1:1: minus = -1, expected 0 or more");
    EXPECT_EQ(message([] { number_in(more_than(0.0), numbers, "zero", "as of a scale"); }),
              "m.toml:2:1: zero = 0, expected more than 0; as of a scale");
    EXPECT_EQ(message([] { optional_number_in(between(0.0, 1.0), numbers, "three"); }),
              "m.toml:4:1: three = 3, expected 0 to 1");
    EXPECT_EQ(message([] { number_in_or(more_than_up_to(0.0, 1.0), numbers, "zero", 1.0); }),
              "m.toml:2:1: zero = 0, expected more than 0 and at most 1");
    EXPECT_EQ(message([] { number_in(at_most(1.0), numbers, "three"); }), "m.toml:4:1: three = 3, expected at most 1");
    EXPECT_EQ(message([] { count_in(numbers, "half"); }), "m.toml:3:1: half = 0.5, expected a whole number");
    EXPECT_EQ(message([] { count_in(numbers, "minus"); }),
              "m.toml:1:1: minus = -1, expected a whole number, 0 or more");
    EXPECT_EQ(message([] { count_in_or(numbers, "three", 4, 9); }),
              "m.toml:4:1: three = 3, expected a whole number, 4 or more");
    EXPECT_EQ(message([] { count_in(numbers, "huge"); }), "m.toml:5:1: huge = 1e+300, expected a whole number");
}

TEST(TomlNumbers, NotANumberIsInNoRange) {
    EXPECT_EQ(message([] { require_in(at_least(0.0), std::nan(""), "x", {"f"}); }), "f: x = nan, expected 0 or more");
}

std::string refusal(const std::string& text) {
    return test::rejected([&] { require_known_format(parse_toml(text, "m.toml")); });
}

TEST(UnknownKeys, OfAllTablesAreReportedTogether) {
    const auto root = parse_toml("rest = 1\nelephant = 2\n[t]\ncruse = 3\n", "m.toml");
    const auto read = [&] {
        root.refuse_keys_except({"reserve", "rest_s", "t"});
        root.table("t").refuse_keys_except({"cruise"});
        root.number("missing");
    };
    EXPECT_EQ(
        test::rejected([&] { root.collect_unknown_keys(read); }),
        "m.toml:1:1: 3 unknown keys: 'rest' in line 1 (did you mean 'rest_s'?), 'elephant' in line 2, 'cruse' in line 4 "
        "(did you mean 'cruise'?); known keys: reserve, rest_s, t");
    EXPECT_EQ(test::rejected(read),
              "m.toml:1:1: 2 unknown keys: 'rest' in line 1 (did you mean 'rest_s'?), 'elephant' in line 2; "
              "known keys: missing, reserve, rest_s, t")
        << "one table alone";
}

TEST(UnknownKeys, OfATableThatIsReadTwiceAreNamedOnce) {
    const auto root = parse_toml("[t]\ncruse = 3\n", "m.toml");
    const auto read = [&] {
        for (int i = 0; i < 2; ++i) root.table("t").refuse_keys_except({"cruise"});
    };
    EXPECT_EQ(test::rejected([&] { root.collect_unknown_keys(read); }),
              "m.toml:2:1: unknown key 'cruse'; did you mean 'cruise'?");
}

TEST(UnknownKeys, AreNamedByPartsAndSynonyms) {
    const auto refused = [](const std::string& key) {
        const auto root = parse_toml(key + " = 1", "m.toml");
        return test::rejected([&] {
            root.refuse_keys_except({"mechanical", "reserve_soc_percent", "airspeed_m_per_s"});
        });
    };
    EXPECT_THAT(refused("reserve"), HasSubstr("did you mean 'reserve_soc_percent'?"));
    EXPECT_THAT(refused("speed"), HasSubstr("did you mean 'airspeed_m_per_s'?"));
    EXPECT_THAT(refused("model"), HasSubstr("did you mean 'mechanical'?"));
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
