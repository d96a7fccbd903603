#include "mission/file/plan_settings_toml.h"

#include "helpers/rejected.h"
#include "mission/mission_file.h"

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
    return folder;
}

AnyMission read(const std::string& text, bool may_lack_schedule = true) {
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

PlanningProblem problem(const std::string& text) { return std::get<PlanningProblem>(read(text)); }

TEST(PlanSettingsToml, HasDefaults) {
    const auto mission = problem(with_utility("{}"));
    EXPECT_EQ(mission.plan.slot_s, 10.0);
    EXPECT_EQ(mission.plan.dwell_s, 0.0);
    EXPECT_EQ(mission.plan.choices[0].levels, (std::vector<std::vector<double>>{{10.0, 30.0}}));
    EXPECT_FALSE(mission.plan.choices[0].may_be_off);
    EXPECT_TRUE(mission.fixed.empty());
    EXPECT_EQ(mission.reserve_soc_percent, 0.0);
    EXPECT_TRUE(std::holds_alternative<Mission>(read(""))) << "nothing to run, nothing to plan";
}

TEST(PlanSettingsToml, ReadsWhatMayBeChosenAndWhatIsFixed) {
    const auto mission =
        problem(with_utility("{}") +
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
    const auto plan = [](const std::string& text) {
        return refused(with_utility("{}") + "[plan]\n" + text + "\n");
    };
    EXPECT_EQ(plan("slot_s = 0"), "m.toml:8:1: slot_s = 0, expected more than 0");
    EXPECT_EQ(plan("dwell_s = -1"), "m.toml:8:1: dwell_s = -1, expected 0 or more");
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
              "m.toml:4:1: reserve_soc_percent = 101, expected 0 to 100");
}

TEST(PlanSettingsToml, IsRefusedWhereAScheduleIsDue) {
    EXPECT_EQ(
        refused(with_utility("{}") + "[plan]\n", false),
        "m.toml:7:2: this mission has no complete schedule: it is yet to be planned; `flightwatt plan` makes "
        "one; without [plan], [[schedule]] is taken as complete");
}

TEST(PlanSettingsToml, FliesAnotherCruise) {
    const auto mission = parse_mission(head + with_utility("{}"), mission_folder() / "m.toml", {true, 123.0});
    EXPECT_EQ(setup_of(mission).duration_s[flight::Phase::cruise], 123.0);
}

}  // namespace
}  // namespace flightwatt::mission
