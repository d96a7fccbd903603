#include "mission/file/planning_toml.h"

#include "helpers/rejected.h"
#include "mission/mission_file.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

const std::string head =
    "mechanical = \"none\"\nduration_s = { takeoff = 0, cruise = 600, landing = 0 }\n"
    "battery = { voltage_v = 10, resistance_ohm = 0, capacity_ah = 3 }\n";

std::filesystem::path mission_folder() {
    auto folder = scratch_dir();
    write_text(folder / "detection.csv", "fps,power_w\n10,20\n30,40\n");
    write_text(folder / "camera.csv", "power_w\n3\n");
    write_text(folder / "two.csv", "fps,width,power_w\n10,1,20\n30,1,40\n10,2,21\n30,2,41\n");
    return folder;
}

MissionVariant read(const std::string& text, bool may_lack_schedule = true) {
    return parse_mission(head + text, mission_folder() / "m.toml", {may_lack_schedule, std::nullopt});
}

std::string refused(const std::string& text, bool may_lack_schedule = true) {
    const auto folder = mission_folder();
    return rejected([&] { parse_mission(head + text, folder / "m.toml", {may_lack_schedule, std::nullopt}); }, folder);
}

/// A detection component with a utility, to be planned.
std::string with_utility(const std::string& utility) {
    return "[components.detection]\nprofile = \"detection.csv\"\nutility = " + utility + "\n";
}

double utility_at(const std::string& utility, double qos) {
    return utility_per_s(setup_of(read(with_utility(utility))).utilities, {{0, {qos}}});
}

TEST(UtilityToml, HasShapes) {
    EXPECT_DOUBLE_EQ(utility_at("{}", 20.0), 20.0);
    EXPECT_DOUBLE_EQ(utility_at("{ parameter = \"fps\", weight = 2.5 }", 20.0), 50.0);
    EXPECT_DOUBLE_EQ(utility_at("{ shape = \"linear\", weight = 0 }", 20.0), 0.0);
    EXPECT_DOUBLE_EQ(utility_at("{ shape = \"sqrt\" }", 25.0), 5.0);
    EXPECT_DOUBLE_EQ(utility_at("{ shape = \"log\", weight = 2 }", 20.0), 2.0 * std::log(21.0));
    const std::string points = "{ shape = \"points\", qos = [0, 10, 20, 30], value = [0, 1, 5, 5], weight = 2 }";
    EXPECT_DOUBLE_EQ(utility_at(points, 10.0), 2.0);
    EXPECT_DOUBLE_EQ(utility_at(points, 15.0), 6.0);
    EXPECT_DOUBLE_EQ(utility_at(points, 30.0), 10.0);
}

TEST(UtilityToml, ReadsTheOlderNameOfItsValues) {
    EXPECT_DOUBLE_EQ(utility_at("{ shape = \"points\", qos = [0, 40], worth = [0, 8] }", 10.0), 2.0);
    EXPECT_EQ(refused(with_utility("{ shape = \"points\", qos = [0, 40], worth = [2, 1] }")),
              "m.toml:6:46: worth falls: better quality cannot have less utility; the numbers must not fall");
    EXPECT_NE(refused(with_utility("{ shape = \"points\", qos = [0, 40], value = [0, 8], worth = [0, 8] }"))
                  .find("`worth` is the older name of `value`"),
              std::string::npos);
}

TEST(UtilityToml, IsTheWeightOfAComponentWithoutParameters) {
    const auto mission = read("[components.camera]\nprofile = \"camera.csv\"\nutility = { weight = 3 }\n");
    const auto& utilities = setup_of(mission).utilities;
    EXPECT_EQ(utility_per_s(utilities, {{0, {}}}), 3.0);
    EXPECT_EQ(utility_per_s(utilities, {}), 0.0);
}

TEST(UtilityToml, RefusesWhatIsNotMonotoneOrUnknown) {
    EXPECT_EQ(refused(with_utility("{ parameter = \"width\" }")),
              "m.toml:6:13: the profile has no parameter 'width'; its parameters are fps");
    EXPECT_EQ(refused(with_utility("{ weight = -1 }")), "m.toml:6:13: weight = -1, expected 0 or more");
    EXPECT_EQ(refused(with_utility("{ shape = \"cubic\" }")),
              "m.toml:6:13: there is no shape 'cubic'; it is \"linear\", \"sqrt\", \"log\" or \"points\"");
    EXPECT_EQ(refused(with_utility("{ wieght = 1 }")), "m.toml:6:13: unknown key 'wieght'; did you mean 'weight'?");
    EXPECT_EQ(refused(with_utility("{ qos = [1, 2] }")),
              "m.toml:6:13: `qos` has no meaning here; it belongs to shape = \"points\"");
    const auto points = [](const std::string& text) {
        return refused(with_utility("{ shape = \"points\", " + text + " }"));
    };
    EXPECT_EQ(points("qos = [0, 40], value = [2, 1]"),
              "m.toml:6:46: value falls: better quality cannot have less utility; the numbers must not fall");
    EXPECT_EQ(points("qos = [40, 0], value = [1, 2]"), "m.toml:6:31: the values of qos do not rise");
    EXPECT_EQ(points("qos = [0], value = [1]"),
              "m.toml:6:42: 1 numbers of qos and 1 of value are no points; give as many of each, 2 or more");
    EXPECT_EQ(points("qos = [12, 40], value = [1, 2]"),
              "m.toml:6:31: the points from 12 to 40 do not cover the profile's range, 10 to 30; add "
              "points at its ends");
    EXPECT_EQ(refused("[components.two]\nprofile = \"two.csv\"\nutility = {}\n"),
              "m.toml:6:11: the profile has 2 parameters: which one has the utility?; add parameter = ..., one of fps, "
              "width");
    EXPECT_EQ(refused("[components.camera]\nprofile = \"camera.csv\"\nutility = { shape = \"sqrt\" }\n"),
              "m.toml:6:13: `shape` has no meaning here; the profile has no parameter: leave it out");
}

PlanningProblem problem(const std::string& text) { return std::get<PlanningProblem>(read(text)); }

TEST(PlanSettingsToml, HasDefaults) {
    const auto mission = problem(with_utility("{}"));
    EXPECT_EQ(mission.plan.slot_s, 10.0);
    EXPECT_EQ(mission.plan.dwell_s, 0.0);
    EXPECT_EQ(mission.plan.choices[0].levels, (std::vector<std::vector<double>>{{10.0, 30.0}}));
    EXPECT_FALSE(mission.plan.choices[0].may_be_off);
    EXPECT_TRUE(mission.fixed.empty());
    EXPECT_EQ(mission.setup.reserve_soc_percent, 0.0);
    EXPECT_TRUE(std::holds_alternative<Mission>(read(""))) << "nothing to run, nothing to plan";
}

TEST(PlanSettingsToml, ReadsWhatMayBeChosenAndWhatIsFixed) {
    const auto mission = problem(with_utility("{}") +
                                 "[plan]\nslot_s = 5\ndwell_s = 20\nmay_be_off = [\"detection\"]\n"
                                 "levels = { detection = { fps = [25, 12, 25] } }\n"
                                 "[[schedule]]\nphase = \"cruise\"\nmiddle = 60\nrun = { detection = { fps = 30 } }\n");
    EXPECT_EQ(mission.plan.slot_s, 5.0);
    EXPECT_EQ(mission.plan.dwell_s, 20.0);
    EXPECT_EQ(mission.plan.choices[0].levels, (std::vector<std::vector<double>>{{12.0, 25.0}}));
    EXPECT_TRUE(mission.plan.choices[0].may_be_off);
    ASSERT_EQ(mission.fixed.size(), 1U);
    EXPECT_EQ(mission.fixed[0].start_s, 270.0);
    EXPECT_EQ(mission.fixed[0].end_s, 330.0);
}

TEST(PlanSettingsToml, RefusesWhatMakesNoSense) {
    const auto plan = [](const std::string& text) { return refused(with_utility("{}") + "[plan]\n" + text + "\n"); };
    EXPECT_EQ(plan("slot_s = 0"), "m.toml:8:1: slot_s = 0, expected more than 0");
    EXPECT_EQ(plan("dwell_s = -1"), "m.toml:8:1: dwell_s = -1, expected 0 or more");
    EXPECT_EQ(plan("slots = 3"), "m.toml:8:1: unknown key 'slots'; did you mean 'slot_s'?");
    EXPECT_EQ(plan("may_be_off = [\"radar\"]"),
              "m.toml:8:1: there is no component 'radar'; the components are detection");
    EXPECT_EQ(plan("levels = { detection = { fps = [] } }"),
              "m.toml:8:26: fps = [] leaves no choice; leave it out for the levels that were profiled");
    EXPECT_NE(plan("levels = { detection = { fps = [31] } }").find("m.toml:8:26: "), std::string::npos);
    EXPECT_EQ(plan("[[schedule]]\notherwise = true\nrun = {}"),
              "m.toml:8:1: `otherwise` leaves nothing to plan; take it out: what no other entry fixes is planned");
    EXPECT_EQ(refused("reserve_soc_percent = 101\n"), "m.toml:4:1: reserve_soc_percent = 101, expected 0 to 100");
}

TEST(PlanSettingsToml, IsRefusedWhereAScheduleIsDue) {
    EXPECT_EQ(refused(with_utility("{}") + "[plan]\n", false),
              "m.toml:7:2: this mission has no complete schedule: it is yet to be planned; `flightwatt plan` makes "
              "one; without [plan], [[schedule]] is taken as complete");
}

TEST(PlanSettingsToml, FliesAnotherCruise) {
    const auto mission = parse_mission(head + with_utility("{}"), mission_folder() / "m.toml", {true, 123.0});
    EXPECT_EQ(setup_of(mission).duration_s[flight::Phase::cruise], 123.0);
}

std::optional<AdaptivePolicy> policy(const std::string& text) {
    return read_adaptive_policy(parse_toml(text, "m.toml"));
}

TEST(AdaptivePolicyToml, ReadsAndRefuses) {
    EXPECT_FALSE(policy(""));
    EXPECT_FALSE(policy("[policy]\nkind = \"static\"\n"));
    EXPECT_EQ(policy("[policy]\nkind = \"adaptive\"\n")->decide_every_s, 0.0);
    EXPECT_EQ(policy("[policy]\nkind = \"adaptive\"\nprobability = 0.9\n")->probability, 0.9);
    const auto refused = [](const std::string& text) { return rejected([&] { policy(text); }); };
    EXPECT_EQ(refused("[policy]\nkind = \"adaptiv\"\n"),
              "m.toml:2:1: there is no policy 'adaptiv'; it is \"adaptive\" or \"static\"");
    EXPECT_EQ(refused("[policy]\nkind = \"static\"\nprobability = 0.9\n"),
              "m.toml:3:1: `probability` has no meaning with kind = \"static\"; leave it out, or make it kind = "
              "\"adaptive\"");
    EXPECT_EQ(refused("[policy]\nkind = \"adaptive\"\ndecide_every_s = 0\n"),
              "m.toml:3:1: decide_every_s = 0, expected 0.1 to 1000000");
}

TEST(PacksToml, AreRead) {
    const auto mission = read("[packs]\ncount = 3\nchange_s = 300\n");
    EXPECT_EQ(setup_of(mission).packs->count, 3U);
    EXPECT_EQ(setup_of(mission).packs->change_s, 300.0);
    EXPECT_FALSE(setup_of(read("")).packs);
}

TEST(PacksToml, OfWrongNumbersAreRefused) {
    const auto without_folder = [](const std::string& packs) { return refused("[packs]\n" + packs); };
    EXPECT_EQ(without_folder("count = 0\nchange_s = 300\n"),
              "m.toml:5:1: count = 0, expected a whole number, 1 or more");
    EXPECT_EQ(without_folder("count = 2.5\nchange_s = 300\n"), "m.toml:5:1: count = 2.5, expected a whole number");
    EXPECT_NE(without_folder("count = 1001\nchange_s = 300\n"), "");
    EXPECT_NE(without_folder("count = 2\nchange_s = -1\n").find("m.toml:6:1: change_s = -1"), std::string::npos);
    EXPECT_NE(without_folder("count = 2\n").find("change_s"), std::string::npos);
    EXPECT_NE(without_folder("count = 2\nchange_time = 300\n").find("change_s"), std::string::npos);
    EXPECT_NE(without_folder("count = 2\nchange_s = 0\nhome = { east_m = 0, north_m = 0 }\n").find("home belongs"),
              std::string::npos);
    EXPECT_NE(without_folder("count = 2\nchange_s = 0\nbattery = [\"no.toml\", \"no.toml\"]\n").find("no.toml"),
              std::string::npos);
    const auto pack = (test::source_dir() / "fits" / "battery" / "paper.toml").string();
    EXPECT_NE(without_folder("count = 2\nchange_s = 0\nbattery = [\"" + pack + "\"]\n").find("1 batteries for 2 packs"),
              std::string::npos);
    EXPECT_NE(rejected([&] {
                  parse_mission(
                      head + "capacity_ah = 3\n[packs]\ncount = 1\nchange_s = 0\nbattery = [\"" + pack + "\"]\n",
                      mission_folder() / "m.toml");
              }).find("capacity_ah, and [packs] has"),
              std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
