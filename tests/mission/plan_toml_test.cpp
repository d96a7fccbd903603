// Utilities and [plan] of a mission file.

#include "helpers/rejected.h"
#include "mission/file/utility_toml.h"
#include "mission/mission.h"
#include "mission/mission_utility.h"

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

Mission read(const std::string& text, bool may_lack_schedule = true) {
    return parse_mission(head + text, mission_folder() / "m.toml", {may_lack_schedule, std::nullopt});
}

std::string refused(const std::string& text, bool may_lack_schedule = true) {
    const auto folder = mission_folder();
    return rejected(
        [&] {
            parse_mission(head + text, folder / "m.toml", {may_lack_schedule, std::nullopt});
        },
        folder);
}

/// A detection component with a utility, to be planned.
std::string with_utility(const std::string& utility) {
    return "[components.detection]\nprofile = \"detection.csv\"\nutility = " + utility + "\n";
}

double worth_at(const std::string& utility, double qos) {
    return worth(read(with_utility(utility)).utilities, {{0, {qos}}});
}

TEST(UtilityToml, HasShapes) {
    EXPECT_DOUBLE_EQ(worth_at("{}", 20.0), 20.0);
    EXPECT_DOUBLE_EQ(worth_at("{ parameter = \"fps\", weight = 2.5 }", 20.0), 50.0);
    EXPECT_DOUBLE_EQ(worth_at("{ shape = \"linear\", weight = 0 }", 20.0), 0.0);
    EXPECT_DOUBLE_EQ(worth_at("{ shape = \"sqrt\" }", 25.0), 5.0);
    EXPECT_DOUBLE_EQ(worth_at("{ shape = \"log\", weight = 2 }", 20.0), 2.0 * std::log(21.0));
    const std::string points =
        "{ shape = \"points\", qos = [0, 10, 20, 30], worth = [0, 1, 5, 5], weight = 2 }";
    EXPECT_DOUBLE_EQ(worth_at(points, 10.0), 2.0);
    EXPECT_DOUBLE_EQ(worth_at(points, 15.0), 6.0);
    EXPECT_DOUBLE_EQ(worth_at(points, 30.0), 10.0);
}

TEST(UtilityToml, IsTheWeightOfAComponentWithoutParameters) {
    const auto mission = read("[components.camera]\nprofile = \"camera.csv\"\nutility = { weight = 3 }\n");
    EXPECT_EQ(worth(mission.utilities, {{0, {}}}), 3.0);
    EXPECT_EQ(worth(mission.utilities, {}), 0.0);
}

TEST(UtilityToml, RefusesWhatIsNotMonotoneOrUnknown) {
    EXPECT_EQ(refused(with_utility("{ parameter = \"width\" }")),
              "m.toml:6:13: the profile has no parameter 'width'; its parameters are fps");
    EXPECT_EQ(refused(with_utility("{ weight = -1 }")),
              "m.toml:6:13: weight = -1 is negative; use 0 for what is worth nothing");
    EXPECT_EQ(refused(with_utility("{ shape = \"cubic\" }")),
              "m.toml:6:13: there is no shape 'cubic'; it is \"linear\", \"sqrt\", \"log\" or \"points\"");
    EXPECT_EQ(refused(with_utility("{ wieght = 1 }")),
              "m.toml:6:13: unknown key 'wieght'; did you mean 'weight'?");
    EXPECT_EQ(refused(with_utility("{ qos = [1, 2] }")),
              "m.toml:6:13: `qos` has no meaning here; it belongs to shape = \"points\"");
    const auto points = [](const std::string& text) {
        return refused(with_utility("{ shape = \"points\", " + text + " }"));
    };
    EXPECT_EQ(points("qos = [0, 40], worth = [2, 1]"),
              "m.toml:6:46: worth falls: better quality cannot be worth less; the values must not fall");
    EXPECT_EQ(points("qos = [40, 0], worth = [1, 2]"), "m.toml:6:31: the values of qos do not rise");
    EXPECT_EQ(points("qos = [0], worth = [1]"),
              "m.toml:6:42: 1 values of qos and 1 of worth are no points; give as many of each, 2 or more");
    EXPECT_EQ(points("qos = [12, 40], worth = [1, 2]"),
              "m.toml:6:31: the points from 12 to 40 leave out some of the profile's range, 10 to 30; add "
              "points at "
              "its ends");
    EXPECT_EQ(
        refused("[components.two]\nprofile = \"two.csv\"\nutility = {}\n"),
        "m.toml:6:11: the profile has 2 parameters: which is it worth by?; add parameter = ..., one of fps, "
        "width");
    EXPECT_EQ(refused("[components.camera]\nprofile = \"camera.csv\"\nutility = { shape = \"sqrt\" }\n"),
              "m.toml:6:13: `shape` has no meaning here; the profile has no parameter: leave it out");
}

TEST(MissionUtility, IsTheMeanOverTheWholeMission) {
    const auto mission =
        read(with_utility("{}") +
                 "[[schedule]]\nphase = \"cruise\"\nto = 200\nrun = { detection = { fps = 30 } }\n"
                 "[[schedule]]\notherwise = true\nrun = {}\n",
             false);
    EXPECT_DOUBLE_EQ(*mean_worth(mission, 600.0), 10.0);
    EXPECT_DOUBLE_EQ(*mean_worth(mission, 100.0), 5.0);
    EXPECT_FALSE(mean_worth(read(""), 600.0));
}

TEST(PlanToml, HasDefaults) {
    const auto mission = read(with_utility("{}"));
    ASSERT_TRUE(mission.plan);
    EXPECT_EQ(mission.plan->slot_s, 10.0);
    EXPECT_EQ(mission.plan->dwell_s, 0.0);
    EXPECT_EQ(mission.plan->choices[0].levels, (std::vector<std::vector<double>>{{10.0, 30.0}}));
    EXPECT_FALSE(mission.plan->choices[0].may_be_off);
    EXPECT_TRUE(mission.schedule.empty());
    EXPECT_EQ(mission.reserve_soc_percent, 0.0);
    EXPECT_FALSE(read("").plan) << "nothing to run, nothing to plan";
}

TEST(PlanToml, ReadsWhatMayBeChosenAndWhatIsFixed) {
    const auto mission =
        read(with_utility("{}") +
             "[plan]\nslot_s = 5\ndwell_s = 20\nmay_be_off = [\"detection\"]\n"
             "levels = { detection = { fps = [25, 12, 25] } }\n"
             "[[schedule]]\nphase = \"cruise\"\nmiddle = 60\nrun = { detection = { fps = 30 } }\n");
    EXPECT_EQ(mission.plan->slot_s, 5.0);
    EXPECT_EQ(mission.plan->dwell_s, 20.0);
    EXPECT_EQ(mission.plan->choices[0].levels, (std::vector<std::vector<double>>{{12.0, 25.0}}));
    EXPECT_TRUE(mission.plan->choices[0].may_be_off);
    ASSERT_EQ(mission.schedule.size(), 1U);
    EXPECT_EQ(mission.schedule[0].from_s, 270.0);
    EXPECT_EQ(mission.schedule[0].to_s, 330.0);
}

TEST(PlanToml, RefusesWhatMakesNoSense) {
    const auto plan = [](const std::string& text) {
        return refused(with_utility("{}") + "[plan]\n" + text + "\n");
    };
    EXPECT_EQ(plan("slot_s = 0"), "m.toml:8:1: slot_s = 0 s makes no sense; expected more than 0");
    EXPECT_EQ(plan("dwell_s = -1"), "m.toml:8:1: dwell_s = -1 s makes no sense; expected 0 or more");
    EXPECT_EQ(plan("slots = 3"), "m.toml:8:1: unknown key 'slots'; did you mean 'slot_s'?");
    EXPECT_EQ(plan("may_be_off = [\"radar\"]"),
              "m.toml:8:1: there is no component 'radar'; the components are detection");
    EXPECT_EQ(plan("levels = { detection = { fps = [] } }"),
              "m.toml:8:26: fps = [] leaves no choice; leave it out for the levels that were profiled");
    EXPECT_NE(plan("levels = { detection = { fps = [31] } }").find("m.toml:8:26: "), std::string::npos);
    EXPECT_EQ(
        plan("[[schedule]]\notherwise = true\nrun = {}"),
        "m.toml:8:1: `otherwise` leaves nothing to plan; take it out: what no other entry fixes is planned");
    EXPECT_EQ(refused("reserve_soc_percent = 101\n"),
              "m.toml:4:1: reserve_soc_percent = 101 is out of range; expected from 0 to 100");
}

TEST(PlanToml, IsRefusedWhereAScheduleIsDue) {
    EXPECT_EQ(
        refused(with_utility("{}") + "[plan]\n", false),
        "m.toml:7:2: this mission has no complete schedule: it is yet to be planned; `flightwatt plan` makes "
        "one; without [plan], [[schedule]] is taken as complete");
}

TEST(MissionReading, FliesAnotherCruise) {
    const auto mission = parse_mission(head + with_utility("{}"), mission_folder() / "m.toml", {true, 123.0});
    EXPECT_EQ(mission.duration_s[flight::Phase::cruise], 123.0);
}

}  // namespace
}  // namespace flightwatt::mission
