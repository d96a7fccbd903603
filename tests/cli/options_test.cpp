// Options: declared once, checked, shown and listed from that declaration.

#include "cli/options.h"

#include "base/error.h"

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

enum class Colour { phase, power };

struct Values {
    bool flag = false;
    std::size_t count = 3;
    double share = 0.5;
    std::optional<double> capacity_ah;
    std::size_t bytes = 100'000'000;
    std::string name = "usual";
    std::vector<std::string> files;
    std::set<std::string> names;
    Colour colour = Colour::phase;
    std::optional<std::chrono::sys_days> since;
    double expert = 1.0;
    double cruise_s = 600.0;
};

/// Values and the options that are bound to them.
struct Declared {
    Values values;
    Options options;

    Declared() {
        options.add("flag,f", values.flag, "a flag", {.excludes = {"files"}});
        options.add("count", values.count, {.value = "N", .min = 1, .max = 24, .old_name = "number"}, "a count");
        options.add("share", values.share, {.value = "X", .min = 0.5, .max = 1.0, .below_max = true}, "a share");
        options.add("capacity", values.capacity_ah,
                    {.value = "AH", .min = 0.0, .max = 200.0, .above_min = true, .unit = "Ah", .hint = "not mAh"},
                    "a capacity");
        options.add("max-mb", values.bytes, {.value = "MB", .min = 1, .scale = 1e6}, "a limit");
        options.add("name", values.name, {.value = "NAME", .needs = {"count", "flag"}}, "a name");
        options.add("files", values.files, input_file("FILE"), "files");
        options.add("names", values.names, {.value = "NAME"}, "names");
        options.add_choice("colour", values.colour, {{"phase", Colour::phase}, {"power", Colour::power}},
                           {.value = "HOW"}, "a colour");
        options.add("since", values.since, {.value = "DATE"}, "a date");
        options.add("cruise", values.cruise_s, {.value = "TIME", .min = 1.0, .unit = "s"}, "a time");
        options.begin_group("Details", true);
        options.add("expert", values.expert, {.value = "X"}, "for experts");
        options.add_rule([this] {
            if (values.expert < 0.0) throw UsageError("the rule");
        });
    }

    std::vector<std::string> set(std::vector<std::string> words) {
        words.insert(words.begin(), "program");
        std::vector<char*> argv;
        for (auto& word : words) argv.push_back(word.data());
        const auto given = options.parse(static_cast<int>(argv.size()), argv.data());
        options.assign(given);
        return given.inputs;
    }
};

Values values_of(const std::vector<std::string>& words) {
    Declared declared;
    declared.set(words);
    return declared.values;
}

std::string refusal(const std::vector<std::string>& words) {
    try {
        Declared().set(words);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing refused";
}

TEST(Options, SetTheVariablesToWhichTheyAreBound) {
    const auto values =
        values_of({"-f",       "--count", "7",       "--share=0.75", "--capacity", "2.2",     "--max-mb",
                   "5",        "--name",  "a",       "--names",      "x",          "--names", "y",
                   "--colour", "power",   "--since", "2020-07-05",   "--expert",   "2"});
    EXPECT_TRUE(values.flag);
    EXPECT_EQ(values.count, 7U);
    EXPECT_EQ(values.share, 0.75);
    EXPECT_EQ(values.capacity_ah, 2.2);
    EXPECT_EQ(values.bytes, 5'000'000U);
    EXPECT_EQ(values.name, "a");
    EXPECT_THAT(values.names, ElementsAre("x", "y"));
    EXPECT_EQ(values.colour, Colour::power);
    EXPECT_EQ(values.since, std::chrono::sys_days(std::chrono::July / 5 / 2020));
    EXPECT_EQ(values.expert, 2.0);
}

TEST(Options, TakeTimesInSecondsMinutesAndHours) {
    for (const auto* text : {"1800", "1800s", "30min", "0.5h"})
        EXPECT_EQ(values_of({"--cruise", text}).cruise_s, 1800.0) << text;
    for (const auto* text : {"30m", "min", "0.5hours", "30 min"})
        EXPECT_THAT(refusal({"--cruise", text}), HasSubstr("90s, 30min or 1.5h")) << text;
}

TEST(Options, LeaveOtherVariablesAsTheyAre) {
    Declared declared;
    EXPECT_THAT(declared.set({"a", "--", "--count"}), ElementsAre("a", "--count"));
    EXPECT_EQ(declared.values.count, 3U);
    EXPECT_FALSE(declared.values.flag);
    EXPECT_FALSE(declared.values.capacity_ah);
}

TEST(Options, HaveTheirOldNamesForOneVersion) {
    EXPECT_EQ(values_of({"--number", "7"}).count, 7U);
    EXPECT_THAT(Declared().options.help_text(true), Not(HasSubstr("--number")));
}

TEST(Options, RefuseWholeNumbersOutsideTheirRange) {
    for (const std::string text : {"-1", "0", "1.5", "many", "25"})
        EXPECT_EQ(refusal({"--count=" + text}), "--count " + text + ": expected a whole number from 1 to 24");
    EXPECT_EQ(refusal({"--max-mb=0"}), "--max-mb 0: expected a whole number from 1");
}

TEST(Options, RefuseNumbersOutsideTheirRange) {
    for (const std::string text : {"0.49", "1"})
        EXPECT_EQ(refusal({"--share=" + text}), "--share " + text + ": expected 0.5 or more and less than 1");
    for (const std::string text : {"nan", "inf", "half"})
        EXPECT_EQ(refusal({"--share=" + text}),
                  "--share " + text + ": expected a number without a unit, 0.5 or more and less than 1");
    for (const std::string text : {"0", "-2", "2200"})
        EXPECT_EQ(refusal({"--capacity=" + text}),
                  "--capacity " + text + ": expected more than 0 and at most 200 Ah; not mAh");
    EXPECT_EQ(refusal({"--expert=x"}), "--expert x: expected a number");
}

TEST(Options, RefuseOtherWordsAndDates) {
    EXPECT_EQ(refusal({"--colour=powr"}), "--colour powr: expected one of phase, power; did you mean 'power'?");
    for (const std::string text : {"2020-02-30", "5 July", "20-07-05"})
        EXPECT_EQ(refusal({"--since=" + text}), "--since " + text + ": expected a date as 2020-07-05");
}

TEST(Options, RefuseWhatDoesNotBelongTogether) {
    EXPECT_EQ(refusal({"--name", "a"}), "--name goes with --count or --flag");
    EXPECT_EQ(refusal({"--flag", "--files", "a"}), "--flag and --files exclude each other: give one of them");
    EXPECT_EQ(refusal({"--expert=-1"}), "the rule");
}

TEST(Options, RefuseUnknownOnes) {
    EXPECT_THAT(refusal({"--cuont", "3"}), HasSubstr("did you mean '--count'?"));
    EXPECT_THAT(refusal({"--wind", "6"}), HasSubstr("answer, check and new-mission have it; a mission states it"))
        << "'--wide' was meant to be meant";
}

TEST(Options, ShowExpertsOnRequest) {
    const Declared declared;
    EXPECT_THAT(declared.options.help_text(false), Not(HasSubstr("--expert")));
    EXPECT_THAT(declared.options.help_text(true), HasSubstr("--expert X (=1)"));
    EXPECT_THAT(declared.options.help_text(false), HasSubstr("--max-mb MB (=100)"));
    EXPECT_THAT(declared.options.help_text(false), HasSubstr("-f [ --flag ]"));
}

TEST(Options, AreListedForCompletion) {
    const auto text = Declared().options.list_text();
    EXPECT_THAT(text, HasSubstr("--flag\t-f\tflag\t\ta flag\n"));
    EXPECT_THAT(text, HasSubstr("--files\t\tinput\tFILE\tfiles\n"));
    EXPECT_THAT(text, HasSubstr("--count\t\tvalue\tN (=3)\ta count\n"));
}

TEST(Options, AreDescribedAsJson) {
    const auto json = Declared().options.json();
    EXPECT_EQ(json.size(), 12U);
    const auto& capacity = json[3];
    EXPECT_EQ(capacity["name"], "capacity");
    EXPECT_EQ(capacity["type"], "number");
    EXPECT_EQ(capacity["unit"], "Ah");
    EXPECT_EQ(capacity["min"], 0.0);
    EXPECT_EQ(capacity["min_is_excluded"], true);
    EXPECT_EQ(json[5]["needs"].dump(), R"(["count","flag"])");
    EXPECT_EQ(json[6]["file"], "input");
    EXPECT_EQ(json[8]["choices"].dump(), R"(["phase","power"])");
    EXPECT_EQ(json[11]["expert"], true);
}

}  // namespace
}  // namespace flightwatt::cli
