#include "path/plans/mission_files.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "path/plan_blocks.h"
#include "path/plan_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

/// A plan of QGroundControl with these items; home is at 100 m above the sea.
std::string qgc(const std::string& items) {
    return fmt::format(R"({{"fileType": "Plan", "version": 1, "mission": {{"version": 2,
"plannedHomePosition": [47.0, 8.0, 100], "items": [{}]}}}})",
                       items);
}

std::string item(int command, int frame, const std::string& parameters) {
    return fmt::format(R"({{"type": "SimpleItem", "command": {}, "frame": {}, "params": [{}]}})", command, frame,
                       parameters);
}

TEST(MissionFiles, FlyWaypointsInEitherFrame) {
    const auto text =
        qgc(item(22, 3, "15, 0, 0, null, 0, 0, 50") + "," + item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," +
            item(16, 0, "5, 0, 0, null, 47.002, 8.0, 170") + "," + item(20, 2, "0, 0, 0, 0, 0, 0, 0"));
    const auto plan = parse_qgc_plan(text, "q.plan", {.radius_m = {}, .is_rotorcraft = true});
    ASSERT_EQ(plan.entries.size(), 4U);
    EXPECT_DOUBLE_EQ(plan.entries[0].geographic->latitude_deg, 47.0);
    EXPECT_EQ(plan.entries[0].altitude_m, std::optional(50.0));
    EXPECT_EQ(plan.entries[1].altitude_m, std::optional(60.0));
    EXPECT_EQ(plan.entries[2].altitude_m, std::optional(70.0));
    EXPECT_EQ(plan.entries[2].hold_s, std::optional(5.0));
    EXPECT_NEAR(parse_plan(text, "q.plan", {}).front().length_m, 4.0 * 111.18,
                0.5);  // 0.001 degrees of latitude at 47 degrees
    EXPECT_TRUE(plan.not_flown.empty());
}

/// ArduPlane and PX4 ignore the time of a waypoint for wings: 10 min of it were counted.
TEST(MissionFiles, OfWingsDoNotWaitAtWaypoints) {
    auto text = qgc(item(16, 3, "600, 0, 0, null, 47.001, 8.0, 60"));
    const auto wing = parse_qgc_plan(text, "q.plan", {});
    EXPECT_FALSE(wing.entries.back().hold_s);
    EXPECT_EQ(wing.not_flown, std::vector<std::string>{"item 1: the hold is not flown, as wings do not wait at "
                                                       "waypoints: circles for a time are NAV_LOITER_TIME"});
    EXPECT_TRUE(wing.missing.empty());
    text.insert(text.find("\"plannedHome"), "\"vehicleType\": 2, ");
    EXPECT_EQ(parse_qgc_plan(text, "q.plan", {}).entries.back().hold_s, std::optional(600.0)) << "of a multirotor";
}

/// Ten minutes of hover were counted at the power of the cruise, and the answer was yes.
TEST(MissionFiles, OfAVtolAreNotFlownAsTheyAreWhereTheyHoverAfterATransition) {
    const auto to_wing = item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60");
    const auto missing = [&](const std::string& items, bool is_rotorcraft = false) {
        return parse_qgc_plan(qgc(item(84, 3, "0, 0, 0, null, 47.0, 8.0, 30") + "," + to_wing + "," +
                                  item(3000, 2, "3, 0, 0, 0, 0, 0, 0") + "," + items),
                              "q.plan", {.radius_m = {}, .is_rotorcraft = is_rotorcraft})
            .missing;
    };
    const std::vector<std::string> first{
        "item 4: it is flown in hover after a transition: its power is taken as that on the wing"};
    const auto wait = item(93, 2, "600, 0, 0, 0, 0, 0, 0");
    const auto away = item(16, 3, "0, 0, 0, null, 47.02, 8.0, 60");
    EXPECT_EQ(missing(wait), first);
    EXPECT_EQ(missing(away), first);
    EXPECT_EQ(missing(item(16, 3, "600, 0, 0, null, 47.01, 8.0, 60")), first) << "it waits at a waypoint";
    EXPECT_EQ(missing(item(85, 3, "0, 0, 0, null, 47.02, 8.0, 0")), first) << "a landing elsewhere";
    EXPECT_TRUE(missing(item(85, 3, "0, 0, 0, null, 47.01, 8.0, 0")).empty()) << "the model's landing hovers";
    EXPECT_TRUE(missing(item(3000, 2, "4, 0, 0, 0, 0, 0, 0") + "," + away).empty()) << "on the wing again";
    EXPECT_TRUE(missing(away, true).empty()) << "by the model of a rotorcraft";
}

TEST(MissionFiles, AreOfAVtolByTheirVehicleOrItsCommands) {
    const auto to_wing = item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60");
    const auto is_of_vtol = [](const std::string& text) { return parse_qgc_plan(text, "q.plan", {}).is_of_vtol; };
    EXPECT_FALSE(is_of_vtol(qgc(to_wing)));
    EXPECT_TRUE(is_of_vtol(qgc(item(84, 3, "0, 0, 0, null, 47.0, 8.0, 30") + "," + to_wing)));
    EXPECT_TRUE(is_of_vtol(qgc(to_wing + "," + item(85, 3, "0, 0, 0, null, 47.0, 8.0, 0"))));
    for (const int type : {1, 2, 20, 22}) {
        auto text = qgc(to_wing);
        text.insert(text.find("\"plannedHome"), fmt::format("\"vehicleType\": {}, ", type));
        EXPECT_EQ(is_of_vtol(text), type >= 20) << type;
    }
}

TEST(MissionFiles, FlyCirclesAndChangeTheAirspeed) {
    const auto plan = parse_qgc_plan(
        qgc(item(178, 2, "0, 14, -1, 0, 0, 0, 0") + "," + item(18, 3, "3, 0, -70, 1, 47.001, 8.0, 60") + "," +
            item(19, 3, "60, 0, 0, 1, 47.002, 8.0, 60") + "," + item(17, 3, "0, 0, 80, 1, 47.002, 8.0, 60")),
        "q.plan", {.radius_m = 50.0, .airspeed_m_per_s = 12.0});
    EXPECT_DOUBLE_EQ(plan.entries[0].geographic->latitude_deg, 47.0) << "home";
    EXPECT_EQ(plan.entries[1].circles, std::optional(3.0));
    EXPECT_EQ(plan.entries[1].radius_m, std::optional(70.0));
    EXPECT_FALSE(plan.entries[1].to_right);
    EXPECT_EQ(plan.entries[1].airspeed_m_per_s, std::optional(14.0));
    EXPECT_NEAR(*plan.entries[2].circles, 60.0 * 14.0 / 314.159, 1e-3);
    EXPECT_EQ(plan.entries[3].circles, std::optional(1.0));
    EXPECT_EQ(plan.not_flown, std::vector<std::string>{"item 4: the circle has no end: it is flown once"});
    EXPECT_EQ(plan.missing, plan.not_flown);
}

/// A plan of one leg, with these keys of the mission.
PlannedSpeed speed_of(const std::string& keys, bool is_rotorcraft = false) {
    auto text = qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60"));
    text.insert(text.find("\"plannedHome"), keys);
    return parse_qgc_plan(text, "q.plan", {.radius_m = {}, .is_rotorcraft = is_rotorcraft})
        .speed.value_or(PlannedSpeed{});
}

TEST(MissionFiles, HaveTheSpeedOfTheirKindOfVehicle) {
    const std::string speeds = R"("cruiseSpeed": 17.5, "hoverSpeed": 6, )";
    for (const int wing : {1, 10, 19, 20, 21, 22})  // with rovers and VTOLs
        EXPECT_EQ(speed_of(fmt::format("{}\"vehicleType\": {}, ", speeds, wing)).m_per_s, 17.5) << wing;
    for (const int rotorcraft : {2, 4, 13, 14})
        EXPECT_EQ(speed_of(fmt::format("{}\"vehicleType\": {}, ", speeds, rotorcraft)).m_per_s, 6.0) << rotorcraft;
    EXPECT_EQ(speed_of(speeds + "\"vehicleType\": 2, ").source, "the plan's hoverSpeed");
    EXPECT_EQ(speed_of(speeds, true).source, "the plan's hoverSpeed (no vehicleType: as a rotorcraft)");
    EXPECT_EQ(speed_of(speeds + "\"vehicleType\": 0, ").source, "the plan's cruiseSpeed (no vehicleType: as a wing)");
    EXPECT_FALSE(speed_of(speeds).is_default);
    const auto untouched = speed_of(R"("cruiseSpeed": 15, "vehicleType": 1, )");
    EXPECT_TRUE(untouched.is_default);
    EXPECT_EQ(untouched.source, "the plan's cruiseSpeed, QGroundControl's default");
    for (const auto* none : {"", R"("cruiseSpeed": 0, )", R"("cruiseSpeed": null, )", R"("hoverSpeed": 5, )"})
        EXPECT_EQ(speed_of(none).m_per_s, 0.0) << none;
    EXPECT_NE(rejected([] { speed_of(R"("cruiseSpeed": 1500, )"); }).find("cruiseSpeed = 1500"), std::string::npos);
}

TEST(MissionFiles, FlyAGroundSpeedAsAnAirspeedAndTimedCirclesWithThePlansSpeed) {
    auto text = qgc(item(19, 3, "60, 0, 50, 1, 47.002, 8.0, 60") + "," + item(178, 2, "1, 8, -1, 0, 0, 0, 0") + "," +
                    item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + item(178, 2, "2, 3, -1, 0, 0, 0, 0"));
    text.insert(text.find("\"plannedHome"), R"("cruiseSpeed": 20, )");
    const auto plan = parse_qgc_plan(text, "q.plan", {});
    EXPECT_NEAR(*plan.entries.at(1).circles, 60.0 * 20.0 / 314.159, 1e-3);
    EXPECT_FALSE(plan.entries.at(1).airspeed_m_per_s) << "the path's";
    EXPECT_EQ(plan.entries.at(2).airspeed_m_per_s, std::optional(8.0));
    EXPECT_EQ(plan.not_flown,
              (std::vector<std::string>{"item 4: the change of speed is not flown: it states no airspeed",
                                        "item 2: the ground speed is flown as an airspeed, which it is in calm air"}));
}

TEST(MissionFiles, ReportUnknownCommandsAndEndlessJumps) {
    const auto plan =
        parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + item(177, 2, "1, -1, 0, 0, 0, 0, 0") +
                           "," + item(4242, 2, "0, 0, 0, 0, 0, 0, 0") + "," + item(4242, 2, "0, 0, 0, 0, 0, 0, 0") +
                           "," + item(2000, 2, "0, 0, 1, 0, 0, 0, 0") + "," + item(94, 3, "0, 0, 0, 0, 47, 8, 0") +
                           "," + item(177, 2, "40, 2, 0, 0, 0, 0, 0")),
                       "q.plan", {});
    const std::vector<std::string> missing{"item 6: command 94 is not flown",
                                           "item 2: the jump to item 1 is not flown: it has no end",
                                           "item 7: the jump to item 40 is not flown: there is no such item"};
    EXPECT_EQ(plan.missing, missing);
    EXPECT_EQ(plan.not_flown, (std::vector<std::string>{"item 5: command 2000 works the camera, and moves nothing",
                                                        "item 3 and 1 more: command 4242 is not flown", missing[0],
                                                        missing[1], missing[2]}));
}

/// Names of the entries from home on, of items with these commands; a jump is {its target, its repetitions}.
std::vector<std::string> flown_items(const std::vector<std::pair<int, int>>& items, const std::string& firmware = "3",
                                     std::vector<std::string>* notes = nullptr) {
    std::vector<std::string> texts;
    for (const auto& [target, times] : items)
        texts.push_back(target == 0 ? item(16, 3, fmt::format("0, 0, 0, null, 47.00{}, 8.0, 60", texts.size() + 1))
                                    : item(177, 2, fmt::format("{}, {}, 0, 0, 0, 0, 0", target, times)));
    auto text = qgc(fmt::format("{}", fmt::join(texts, ",")));
    text.insert(text.find("\"plannedHome"), fmt::format("\"firmwareType\": {}, ", firmware));
    const auto plan = parse_qgc_plan(text, "q.plan", {});
    if (notes != nullptr) *notes = plan.not_flown;
    std::vector<std::string> names;
    for (const auto& entry : plan.entries) names.push_back(entry.name);
    names.erase(names.begin());  // home
    return names;
}

constexpr std::pair<int, int> waypoint{0, 0};

TEST(MissionFiles, RepeatItemsByJumps) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(flown_items({waypoint, waypoint, {2, 2}, waypoint}),
              (Names{"item 1", "item 2", "item 2, round 2", "item 2, round 3", "item 4"}));
    EXPECT_EQ(flown_items({waypoint, {4, 1}, waypoint, waypoint, {1, 1}}),
              (Names{"item 1", "item 4", "item 1, round 2", "item 3", "item 4, round 2"}))
        << "forward, once; back from the end";
    EXPECT_EQ(flown_items({waypoint, {1, 0}}), Names{"item 1"});
    EXPECT_NE(rejected([] {
                  flown_items({waypoint, {1, 30000}});
              }).find("its jumps repeat more than 2000 items; state fewer repetitions"),
              std::string::npos);
}

TEST(MissionFiles, CountNestedJumpsAsTheirAutopilot) {
    const std::vector<std::pair<int, int>> nested{waypoint, {1, 1}, waypoint, {1, 2}};
    std::vector<std::string> notes;
    EXPECT_EQ(flown_items(nested, "3", &notes).size(), 3U * 3U);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes.front().find("item 2: the jump is repeated in each round of another"), std::string::npos);
    EXPECT_EQ(flown_items(nested, "12", &notes).size(), 2U * 3U + 1U) << "PX4";
    EXPECT_TRUE(notes.empty());
}

TEST(MissionFiles, JumpByTheNumbersOfTheFile) {
    auto numbered = [number = 3](int command, const std::string& parameters) mutable {
        auto text = item(command, 3, parameters);
        text.insert(1, fmt::format("\"doJumpId\": {}, ", ++number));
        return text;
    };
    auto items = numbered(16, "0, 0, 0, null, 47.001, 8.0, 60") + ",";
    items += numbered(16, "0, 0, 0, null, 47.002, 8.0, 60") + ",";
    items += numbered(177, "5, 1, 0, 0, 0, 0, 0");
    const auto plan = parse_qgc_plan(qgc(items), "q.plan", {});
    ASSERT_EQ(plan.entries.size(), 4U);
    EXPECT_EQ(plan.entries.back().name, "item 2, round 2");
    const auto rows = parse_wpl(
        "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t47.0\t8.0\t100\t1\n"
        "1\t0\t3\t16\t0\t0\t0\t0\t47.001\t8\t60\t1\n"
        "2\t0\t3\t16\t0\t0\t0\t0\t47.002\t8\t60\t1\n"
        "3\t0\t3\t177\t2\t1\t0\t0\t0\t0\t0\t1\n",
        "w.waypoints", {});
    EXPECT_EQ(rows.entries.back().name, "item 2 (line 4), round 2");
}

TEST(MissionFiles, AssumeTheRadiusThatCirclesDoNotState) {
    const auto plan_of = [](int command, const AutopilotSettings& settings) {
        return parse_qgc_plan(qgc(item(command, 3, "50, 0, 0, 1, 47.001, 8.0, 60")), "q.plan", settings);
    };
    const auto wing = plan_of(18, {});
    EXPECT_EQ(wing.entries.back().radius_m, std::optional(80.0));
    EXPECT_EQ(wing.entries.back().circles, std::optional(50.0));
    EXPECT_EQ(wing.not_flown, std::vector<std::string>{"item 1: the circle has no radius: 80 m are assumed, of PX4; "
                                                       "radius_m in [path] states another"});
    EXPECT_TRUE(wing.missing.empty());
    EXPECT_EQ(plan_of(18, {.radius_m = {}, .is_rotorcraft = true}).entries.back().radius_m, std::optional(10.0));
    const auto stated = plan_of(18, {.radius_m = 55.0});
    EXPECT_EQ(stated.entries.back().radius_m, std::optional(55.0));
    EXPECT_TRUE(stated.not_flown.empty());
    const auto held = parse_qgc_plan(qgc(item(19, 3, "50, 0, 30, 1, 47.001, 8.0, 60")), "q.plan",
                                     {.radius_m = {}, .is_rotorcraft = true});
    EXPECT_EQ(held.entries.back().hold_s, std::optional(50.0)) << "its radius is that of wings";
    EXPECT_FALSE(held.entries.back().circles);
    EXPECT_EQ(plan_of(19, {.radius_m = {}, .is_rotorcraft = true}).entries.back().hold_s, std::optional(50.0));
}

/// Their number was that of calm air and of the stated radius: in a wind, or with more bank than the limit, 10 min
/// became up to 66.
TEST(MissionFiles, CircleForTheStatedTime) {
    const auto text =
        qgc(item(19, 3, "600, 0, 10, 1, 47.001, 8.0, 60") + "," + item(19, 3, "600, 0, -100, 1, 47.001, 8.0, 60"));
    for (const double wind_m_per_s : {0.0, 8.0}) {
        AutopilotSettings settings{.radius_m = {}, .airspeed_m_per_s = 13.0};
        settings.wind = {wind_m_per_s, 270.0};
        const auto plan = parse_qgc_plan(text, "q.plan", settings);
        const auto stated = plan.entries.size() - 2;
        for (const auto& [entry, radius_m] :
             {std::pair{stated, std::pow(13.0 + wind_m_per_s, 2) / 9.80665}, {stated + 1, 100.0}}) {
            constexpr int steps = 3600;
            double circle_s = 0.0;
            for (int i = 0; i < steps; ++i) {
                const double course = 2.0 * std::numbers::pi * i / steps;
                const double across = wind_m_per_s * std::cos(course);
                circle_s += 2.0 * std::numbers::pi * radius_m / steps /
                            (std::sqrt(13.0 * 13.0 - across * across) + wind_m_per_s * std::sin(course));
            }
            EXPECT_NEAR(*plan.entries[entry].circles * circle_s, 600.0, 1.0) << wind_m_per_s << ", " << radius_m;
        }
    }
}

/// QGroundControl saves null before it knows the terrain: the altitude was that of the item before, without a note.
TEST(MissionFiles, StateThatAnAltitudeIsUnknown) {
    const auto without_altitude = [](const std::string& more) {
        return fmt::format(R"({{"type": "SimpleItem", "command": 16, "frame": 0,
"params": [0, 0, 0, null, 47.001, 8.0, null]{}}})",
                           more);
    };
    const auto before = item(16, 3, "0, 0, 0, null, 47.002, 8.0, 60") + ",";
    const auto unknown = parse_qgc_plan(qgc(before + without_altitude("")), "q.plan", {});
    EXPECT_FALSE(unknown.entries.back().altitude_m);
    EXPECT_EQ(unknown.missing,
              std::vector<std::string>{"item 2: its altitude is not stated: it is flown as high as the "
                                       "item before"});
    const auto above_terrain = parse_qgc_plan(
        qgc(before + without_altitude(R"(, "AMSLAltAboveTerrain": null, "Altitude": 80, "AltitudeMode": 3)")), "q.plan",
        {});
    EXPECT_EQ(above_terrain.entries.back().altitude_m, std::optional(80.0));
    EXPECT_EQ(above_terrain.missing.size(), 1U) << "without tiles of the terrain";
    EXPECT_TRUE(
        parse_qgc_plan(qgc(before + item(18, 3, "2, 0, 60, 1, null, null, null")), "q.plan", {}).missing.empty())
        << "circles where it is";
}

TEST(MissionFiles, FlyAGroundSpeedOfWingsAsAnAirspeed) {
    for (const bool is_rotorcraft : {false, true}) {
        const auto plan = parse_qgc_plan(
            qgc(item(178, 2, "1, 9, -1, 0, 0, 0, 0") + "," + item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60")), "q.plan",
            {.radius_m = {}, .is_rotorcraft = is_rotorcraft});
        EXPECT_EQ(plan.entries.back().airspeed_m_per_s, std::optional(9.0));
        EXPECT_EQ(plan.not_flown.empty(), is_rotorcraft);
    }
}

TEST(MissionFiles, FlyToTheLandingOfAPattern) {
    const auto plan = parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") +
                                         R"(, {"type": "ComplexItem", "complexItemType": "fwLandingPattern",
"version": 2, "landCoordinate": [47.02, 8.0, 0], "landingApproachCoordinate": [47.03, 8.0, 40], "loiterRadius": 75})"),
                                     "q.plan", {});
    ASSERT_EQ(plan.entries.size(), 4U);
    EXPECT_DOUBLE_EQ(plan.entries[2].geographic->latitude_deg, 47.03);
    EXPECT_EQ(plan.entries[2].altitude_m, std::optional(40.0));
    EXPECT_DOUBLE_EQ(plan.entries[3].geographic->latitude_deg, 47.02);
    EXPECT_FALSE(plan.entries[3].altitude_m) << "the descent is the mission's landing";
    EXPECT_TRUE(plan.missing.empty());
}

/// Waypoints behind the return were flown, which no autopilot does.
TEST(MissionFiles, EndWithTheReturn) {
    const auto plan =
        parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + item(20, 2, "0, 0, 0, 0, 0, 0, 0") +
                           "," + item(16, 3, "0, 0, 0, null, 47.1, 8.0, 60")),
                       "q.plan", {});
    ASSERT_EQ(plan.entries.size(), 3U);
    EXPECT_DOUBLE_EQ(plan.entries[2].geographic->latitude_deg, 47.0);
    EXPECT_EQ(plan.not_flown,
              std::vector<std::string>{"item 3: it follows the return, with which the mission ends: not flown"});
    EXPECT_TRUE(plan.missing.empty());
}

TEST(MissionFiles, NameMovementsThatAreMissing) {
    const auto missing_of = [](const std::string& more) {
        return parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + more), "q.plan", {}).missing;
    };
    using Texts = std::vector<std::string>;
    EXPECT_EQ(missing_of(R"({"type": "ComplexItem", "complexItemType": "StructureScan", "version": 3})"),
              Texts{"item 2 (StructureScan): not flown"});
    EXPECT_EQ(missing_of(item(22, 3, "0, 0, 0, null, 47.001, 8.0, 60")), Texts{"item 2: the take-off is not flown"});
    EXPECT_EQ(missing_of(item(17, 3, "0, 0, 0, 1, 47.001, 8.0, 60")),
              Texts{"item 2: the circle has no end: it is flown once"});
    EXPECT_EQ(missing_of(item(201, 3, "0, 0, 0, 0, 47.001, 8.0, 60")), Texts{}) << "a camera's target";
}

/// Surveys of QGroundControl may have gates where they take images: they were left out, with the way between them.
TEST(MissionFiles, FlyThroughGates) {
    const auto plan =
        parse_qgc_plan(qgc(item(4501, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + item(206, 2, "9, 0, 1, 0, 0, 0, 0") +
                           "," + item(4501, 3, "0, 0, 0, null, 47.002, 8.0, 60")),
                       "q.plan", {});
    ASSERT_EQ(plan.entries.size(), 3U);
    EXPECT_DOUBLE_EQ(plan.entries[2].geographic->latitude_deg, 47.002);
    EXPECT_EQ(plan.entries[2].altitude_m, std::optional(60.0));
    EXPECT_EQ(plan.not_flown.back(),
              "item 1 and 1 more: the gate is flown through as a waypoint; PX4 flies past one that is off its way");
    EXPECT_TRUE(plan.missing.empty());
}

TEST(MissionFiles, AreUncertainWithCommandsThatFlyToAPlace) {
    for (const int command : {31000, 31004, 30001}) {
        const auto plan = parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," +
                                             item(command, 3, "0, 0, 0, null, 47.002, 8.0, 60")),
                                         "q.plan", {});
        EXPECT_EQ(plan.missing, std::vector{fmt::format("item 2: command {} is not flown", command)});
    }
}

/// Multirotors pass a waypoint at its altitude: 90 m on a way of 10 m were climbed at 5 m/s, twice as fast as flown.
TEST(MissionFiles, WaitForAnAltitude) {
    const auto text =
        qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60") + "," + item(31, 3, "0, 60, 0, 1, 47.002, 8.0, 400"));
    const auto wing = parse_qgc_plan(text, "q.plan", {});
    EXPECT_FALSE(wing.entries[1].waits_for_altitude);
    EXPECT_TRUE(wing.entries[2].waits_for_altitude);
    EXPECT_TRUE(wing.missing.empty());
    EXPECT_TRUE(parse_qgc_plan(text, "q.plan", {.radius_m = {}, .is_rotorcraft = true}).entries[1].waits_for_altitude);
}

/// A rover's plan fitted the pack of a wing.
TEST(MissionFiles, AreUncertainForAnotherKindOfVehicle) {
    const auto missing = [](int type, bool is_rotorcraft) {
        auto text = qgc(item(16, 3, "0, 0, 0, null, 47.001, 8.0, 60"));
        text.insert(text.find("\"plannedHome"), fmt::format("\"vehicleType\": {}, ", type));
        return parse_qgc_plan(text, "q.plan", {.radius_m = {}, .is_rotorcraft = is_rotorcraft}).missing;
    };
    using Texts = std::vector<std::string>;
    constexpr int any = 0, wing = 1, quadrotor = 2, airship = 7, rover = 10, boat = 11, vtol = 20;
    for (const int type : {airship, rover, boat})
        EXPECT_EQ(missing(type, false), Texts{"it is for a vehicle that is neither a wing, a multirotor nor a VTOL"});
    EXPECT_EQ(missing(vtol, true), Texts{"it is for a VTOL, and the model of a rotorcraft"});
    for (const int type : {any, wing, quadrotor, vtol}) EXPECT_EQ(missing(type, false), Texts{}) << type;
}

TEST(MissionFiles, BeginAtHomeAlsoWithATakeOffElsewhere) {
    const auto from = [](const std::string& takeoff) {
        return parse_qgc_plan(qgc(item(22, 3, takeoff) + "," + item(16, 3, "0, 0, 0, 0, 47.001, 8.0, 60")), "q.plan",
                              {});
    };
    const auto far = from("0, 0, 0, 0, 47.03, 8.0, 50");
    ASSERT_EQ(far.entries.size(), 3U);
    EXPECT_TRUE(far.starts_at_home);
    EXPECT_DOUBLE_EQ(far.entries[0].geographic->latitude_deg, 47.0);
    EXPECT_FALSE(far.entries[0].altitude_m);
    EXPECT_EQ(far.entries[1].altitude_m, std::optional(50.0));
    for (const auto* near : {"0, 0, 0, 0, 47.00005, 8.0, 50", "0, 0, 0, 0, 0, 0, 50"}) {
        EXPECT_EQ(from(near).entries.size(), 2U) << near;
        EXPECT_FALSE(from(near).starts_at_home) << near;
    }
}

TEST(MissionFiles, EndWithALandingOnlyIfNothingFollows) {
    const auto way = item(16, 3, "0, 0, 0, 0, 47.001, 8.0, 60");
    const auto landing = item(21, 3, "0, 0, 0, 0, 47.03, 8.0, 0");
    EXPECT_TRUE(parse_qgc_plan(qgc(way + "," + landing), "q.plan", {}).ends_with_landing);
    EXPECT_FALSE(parse_qgc_plan(qgc(way), "q.plan", {}).ends_with_landing);
    EXPECT_FALSE(parse_qgc_plan(qgc(landing + "," + way), "q.plan", {}).ends_with_landing);
}

TEST(MissionFiles, FlyNoAltitudeAboveTheSeaIfThatOfHomeIsUnknown) {
    auto text = qgc(item(22, 3, "0, 0, 0, 0, 0, 0, 50") + "," + item(16, 0, "0, 0, 0, 0, 47.001, 8.0, 170"));
    text.replace(text.find(", 100]"), 6, ", null]");
    const auto plan = parse_qgc_plan(text, "q.plan", {});
    ASSERT_EQ(plan.entries.size(), 2U);
    EXPECT_FALSE(plan.entries[1].altitude_m);
    EXPECT_EQ(plan.not_flown,
              std::vector<std::string>{
                  "item 2: the altitude above the sea is not flown, as the plan does not state that of home"});
}

/// Ground stations write zeros where home is not set: 560 m above the sea were flown as above home.
TEST(MissionFiles, FlyNoAltitudeAboveTheSeaIfHomeIsNotSet) {
    auto text = qgc(item(16, 0, "0, 0, 0, 0, 47.001, 8.0, 560") + "," + item(16, 0, "0, 0, 0, 0, 47.002, 8.0, 560"));
    text.replace(text.find("[47.0, 8.0, 100]"), 16, "[0, 0, 0]");
    const auto plan = parse_qgc_plan(text, "q.plan", {});
    EXPECT_FALSE(plan.entries[1].altitude_m);
    EXPECT_EQ(plan.missing.size(), 1U);
    const auto lines =
        parse_wpl("QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t0\t0\t0\t1\n1\t0\t0\t16\t0\t0\t0\t0\t47.001\t8\t560\t1\n",
                  "w.waypoints", {});
    EXPECT_FALSE(lines.entries[0].altitude_m);
    EXPECT_EQ(lines.missing.size(), 1U);
}

TEST(MissionFiles, OfPx4HaveNoHome) {
    const auto plan = parse_wpl(
        "QGC WPL 110\n0\t1\t3\t22\t15\t0\t0\t0\t47.0\t8.0\t50\t1\n"
        "1\t0\t3\t16\t0\t0\t0\t0\t47.001\t8\t60\t1\n",
        "w.waypoints", {});
    ASSERT_EQ(plan.entries.size(), 2U);
    EXPECT_FALSE(plan.starts_at_home);
    EXPECT_EQ(plan.entries[0].altitude_m, std::optional(50.0));
    EXPECT_EQ(plan.entries[1].altitude_m, std::optional(60.0));
}

TEST(MissionFiles, OfBrokenPlansAreErrors) {
    const auto refusal = [](const std::string& text) { return rejected([&] { parse_qgc_plan(text, "q.plan", {}); }); };
    EXPECT_EQ(refusal("{\n1"), "q.plan:2: is not JSON; expected a plan of QGroundControl");
    EXPECT_EQ(refusal(R"({"type": "Polygon"})"),
              "q.plan: is GeoJSON, not a plan; flightwatt new-mission --plan FILE makes a mission of it");
    EXPECT_EQ(refusal("{}"), "q.plan: has no \"fileType\": \"Plan\"; expected a plan of QGroundControl");
    EXPECT_EQ(refusal(qgc(R"({"type": "SimpleItem", "command": 1e9, "frame": 3, "params": []})")),
              "q.plan: item 1 has no command that is a whole number; save the plan again");
    EXPECT_EQ(refusal(qgc(R"({"type": "Other"})")), "q.plan: item 1 has type Other; expected SimpleItem");
    EXPECT_NE(refusal(qgc(item(18, 3, "1e9, 0, 70, 1, 47.001, 8.0, 60"))).find("the number of circles = 1"),
              std::string::npos);
    EXPECT_EQ(refusal(R"({"fileType": "Plan", "version": 42})"), "q.plan: the plan has version 42; expected version 1");
    EXPECT_EQ(refusal(R"({"fileType": "Plan", "version": 1})"), "q.plan: has no mission; add items in QGroundControl");
    EXPECT_EQ(refusal(qgc(item(16, 3, "0, 0, 0"))), "q.plan: item 1 has 3 params; expected 7");
    EXPECT_EQ(refusal(qgc(item(16, 3, "0, 0, 0, 0, 97, 8, 5"))),
              "q.plan: item 1 is at latitude 97, longitude 8; expected degrees");
    EXPECT_EQ(refusal(qgc(item(16, 99, "0, 0, 0, 0, 47, 8, 5"))),
              "q.plan: item 1 has its altitude in frame 99; expected 0 (above the sea), 3 (above home) or 10 (above "
              "the terrain)");
    EXPECT_EQ(refusal(qgc("")), "q.plan: no item of the mission can be flown; it has no items");
}

TEST(MissionFiles, OfWaypointFilesHaveTheirLine) {
    const std::string home = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t47.0\t8.0\t100\t1\n";
    const auto plan =
        parse_wpl(home +
                      "1\t0\t3\t16\t0\t0\t0\t0\t47.001\t8\t60\t1\n"
                      "2\t0\t0\t16\t0\t0\t0\t0\t47.002\t8\t170\t1\n3\t0\t3\t177\t1\t-1\t0\t0\t0\t0\t0\t1\n",
                  "w.waypoints", {});
    ASSERT_EQ(plan.entries.size(), 3U) << "from home";
    EXPECT_EQ(plan.entries[2].altitude_m, std::optional(70.0));
    EXPECT_EQ(plan.not_flown,
              std::vector<std::string>{"item 3 (line 5): the jump to item 1 is not flown: it has no end"});
    const auto refusal = [](const std::string& text) { return rejected([&] { parse_wpl(text, "w", {}); }); };
    EXPECT_EQ(refusal("east_m\n"), "w:1: begins with 'east_m'; expected \"QGC WPL 110\"");
    EXPECT_EQ(refusal(home + "1\t0\t3\n"), "w:3: has 3 numbers; expected 12: is the file cut off?");
    EXPECT_EQ(refusal(home + "1\tx\n"), "w:3: 'x' is no number; expected 12 numbers");
    EXPECT_EQ(refusal("QGC WPL 110\n"), "w: has no items; expected home and waypoints");
}

TEST(MissionFiles, OfWaypointFilesMayHaveAByteOrderMarkOrNoHome) {
    const std::string home = "0\t1\t0\t16\t0\t0\t0\t0\t47.0\t8.0\t100\t1\n";
    const std::string place = "1\t0\t3\t16\t0\t0\t0\t0\t47.001\t8\t60\t1\n";
    EXPECT_EQ(parse_wpl("\xEF\xBB\xBFQGC WPL 110\n" + home + place, "w", {}).entries.size(), 2U);
    const auto without = parse_wpl("QGC WPL 120\n" + place, "w", {});
    ASSERT_EQ(without.entries.size(), 1U);
    EXPECT_EQ(without.entries.front().name, "item 1 (line 2)");
    EXPECT_NE(rejected([] { parse_wpl("QGC WPL 120\n", "w", {}); }).find("no item"), std::string::npos);
}

TEST(MissionFiles, FlyOneAirspeedWhereAsked) {
    const auto text = qgc(item(178, 2, "0, 14, -1, 0, 0, 0, 0") + "," + item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60") +
                          "," + item(19, 3, "60, 0, 50, 1, 47.002, 8.0, 60"));
    const auto entries =
        parse_qgc_plan(text, "q.plan", {.radius_m = {}, .airspeed_m_per_s = 12.0, .one_airspeed = true}).entries;
    ASSERT_EQ(entries.size(), 3U);
    for (const auto& entry : entries) EXPECT_FALSE(entry.airspeed_m_per_s);
    EXPECT_NEAR(*entries.back().circles, 60.0 * 12.0 / 314.159, 1e-3);
}

TEST(MissionFiles, NameAReturnThatIsNotWhereTheAutopilotGoes) {
    const auto there = item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60") + "," + item(20, 2, "0, 0, 0, 0, 0, 0, 0");
    EXPECT_TRUE(parse_qgc_plan(qgc(there), "q.plan", {}).missing.empty());
    auto rally = qgc(there);
    rally.insert(1, R"("rallyPoints": {"points": [[47.1, 8, 50]], "version": 2}, )");
    EXPECT_EQ(parse_qgc_plan(rally, "q.plan", {}).missing,
              std::vector<std::string>{"item 2: the return is flown to home, not to one of the plan's rally points"});
    EXPECT_EQ(parse_qgc_plan(qgc(item(179, 0, "0, 0, 0, 0, 47.03, 8.0, 100") + "," + there), "q.plan", {}).missing,
              std::vector<std::string>{"item 1: command 179 is not flown"});
}

TEST(MissionFiles, ChangeTheirSpeedBackToThatOfTheSettings) {
    const auto place = item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60");
    const auto plan = parse_qgc_plan(qgc(item(178, 2, "0, 12, -1, 0, 0, 0, 0") + "," + place + "," +
                                         item(178, 2, "0, -2, -1, 0, 0, 0, 0") + "," + place),
                                     "q.plan", {});
    EXPECT_EQ(plan.entries[1].airspeed_m_per_s, 12.0);
    EXPECT_FALSE(plan.entries[2].airspeed_m_per_s);
    EXPECT_TRUE(plan.not_flown.empty());
}

TEST(MissionFiles, KeepTheAltitudeWhereAnItemStatesNone) {
    const auto plan =
        parse_qgc_plan(qgc(item(16, 3, "0, 0, 0, null, 47.01, 8.0, 60") + "," + item(19, 3, "30, 0, 0, 0, 0, 0, 0")),
                       "q.plan", {.radius_m = {}, .is_rotorcraft = true});
    EXPECT_FALSE(plan.entries.back().altitude_m);
}

TEST(MissionFiles, HaveCirclesAsWideAsTheirAutopilotFliesThem) {
    const auto radius_m = [](const std::string& firmware) {
        auto text = qgc(item(18, 3, "2, 0, 0, 0, 47.01, 8.0, 60"));
        text.insert(text.find("\"version\": 2"), firmware);
        return parse_qgc_plan(text, "q.plan", {}).entries.back().radius_m;
    };
    EXPECT_EQ(radius_m(R"("firmwareType": 12, )"), 80.0);
    EXPECT_EQ(radius_m(R"("firmwareType": 3, )"), 60.0);
}

TEST(MissionFiles, FlyAltitudesAboveTheTerrainByItsHeights) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "two_rows";
    std::filesystem::create_directories(folder);
    const char heights[] = "\x01\x2C\x01\x2C\x00\x64\x00\x64";  // 300 m in the north, 100 m in the south
    write_file_atomically(folder / "N47E008.hgt", std::string(heights, 8));
    const auto text =
        qgc(item(16, 3, "0, 0, 0, null, 47.1, 8.1, 60") + "," + item(16, 10, "0, 0, 0, null, 47.3, 8.1, 60"));
    const auto plan = parse_qgc_plan(text, "q.plan", {.radius_m = {}, .terrain = folder});
    EXPECT_NEAR(plan.entries.back().altitude_m.value(), 60.0 + 200.0 * 0.3, 1e-6) << "home is at 47 degrees, 100 m";
    EXPECT_TRUE(plan.missing.empty());
    // Heights were counted from the plan's home, wherever it takes off.
    const auto from_ridge =
        parse_qgc_plan(text, "q.plan", {.radius_m = {}, .terrain = folder, .home = GeodeticPosition{47.5, 8.1}});
    EXPECT_NEAR(from_ridge.entries.back().altitude_m.value(), 60.0 - 200.0 * 0.2, 1e-6) << "home is at 200 m";
    const auto flat = parse_qgc_plan(text, "q.plan", {});
    EXPECT_EQ(flat.entries.back().altitude_m, 60.0);
    EXPECT_EQ(flat.missing,
              std::vector<std::string>{"item 2: the altitude above the terrain is flown as one above home: terrain "
                                       "(--terrain) names a folder of its heights"});
}

TEST(MissionFiles, OfRealPlansAreFlownOrRefused) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::shared_dir() / "plans";
    const auto length_of = [&](const std::string& name) {
        return parse_plan(read_file(folder / name), name, {60.0, 15.0}).front().length_m;
    };
    EXPECT_GT(length_of("qgroundcontrol/qgroundcontrol_sample.plan"), 200.0);
    EXPECT_GT(length_of("qgroundcontrol/qgroundcontrol_sample_with_survey.plan"), 100.0);
    EXPECT_GT(length_of("ardupilot/Plockton.waypoints"), 50e3);
    for (const auto* broken : {"with_survey_wrong_version", "with_survey_missing_items", "wrong_mission_version",
                               "without_mission", "wrong_overall_version"}) {
        const auto name = fmt::format("qgroundcontrol/qgroundcontrol_sample_{}.plan", broken);
        EXPECT_THROW(length_of(name), InputError) << name;
    }
}

}  // namespace
}  // namespace flightwatt::path
