#include "path/plan_blocks.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"
#include "path/plan_files.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using std::numbers::pi;
using test::rejected;

/// A plan with a block of these stages; S1 to S4 are a square of 400 m.
std::string plan_of(const std::string& stages) {
    return fmt::format(R"(<!DOCTYPE flight_plan SYSTEM "flight_plan.dtd">
<flight_plan alt="260" ground_alt="185" lat0="43.46223" lon0="1.27289" name="test">
<waypoints>
<waypoint name="HOME" x="0" y="0"/><waypoint name="1" x="100" y="0"/><waypoint name="2" x="100" y="300" alt="280"/>
<waypoint name="S1" x="0" y="0"/><waypoint name="S2" x="400" y="0"/><waypoint name="S3" x="400" y="400"/>
<waypoint name="S4" x="0" y="400"/><waypoint name="low" x="9" y="9" height="30"/>
</waypoints>
<variables><variable var="sweep" init="50."/></variables>
<blocks><block name="Test">{}</block></blocks></flight_plan>)",
                       stages);
}

PlanEntries read(const std::string& stages, const AutopilotSettings& settings = {60.0, 12.0}) {
    return parse_plan_blocks(plan_of(stages), "p.xml", {"Test"}, settings);
}

double length_m(const std::string& stages) {
    return parse_plan(plan_of(stages), "p.xml", {60.0, 12.0}).front().length_m;
}

TEST(PlanBlocks, FlyRoutesAndPaths) {
    EXPECT_NEAR(length_m(R"(<go wp="1"/><go wp="2"/>)"), 300.0, 1e-9);
    EXPECT_NEAR(length_m(R"(<go from="HOME" wp="2" hmode="route"/>)"), std::hypot(100.0, 300.0), 1e-9);
    EXPECT_NEAR(length_m(R"(<path wpts="S1, S2,S3 S4"/>)"), 1200.0, 1e-9);
    const auto entries = read(R"(<go wp="1"/><go wp="2"/><go wp="low"/><go wp="1" alt="GetAltRef()+40"/>)").entries;
    EXPECT_EQ(entries[0].altitude_m, std::optional(260.0));
    EXPECT_EQ(entries[1].altitude_m, std::optional(280.0));
    EXPECT_EQ(entries[2].altitude_m, std::optional(215.0));
    EXPECT_EQ(entries[3].altitude_m, std::optional(225.0));
}

/// Rounds for a time were counted by the airspeed, whatever the wind.
TEST(PlanBlocks, FlyRoundsForATimeInTheWind) {
    AutopilotSettings settings{60.0, 12.0};
    settings.wind = {6.0, 180.0};
    const auto circles_of = [&](const char* stage) { return read(stage, settings).entries.front().circles.value(); };
    const double circle_s = circle_time_s(60.0, 12.0, settings.wind, {});
    EXPECT_GT(circle_s, 1.15 * 2.0 * pi * 60.0 / 12.0);
    EXPECT_NEAR(circles_of(R"(<circle wp="1" radius="nav_radius" until="stage_time>300"/>)") * circle_s, 300.0, 1e-6);
    const double oval_s = circle_s + 300.0 / 18.0 + 300.0 / 6.0;  // its lines along the wind
    const auto legs = [&](double time_s) {
        return read(fmt::format(R"(<oval p1="1" p2="2" radius="60" until="stage_time>{}"/>)", time_s), settings)
            .entries.size();
    };
    EXPECT_EQ(legs(2.9 * oval_s), legs(2.1 * oval_s));
    EXPECT_LT(legs(1.9 * oval_s), legs(2.1 * oval_s));
}

TEST(PlanBlocks, NameTheMovementsThatAreMissing) {
    const auto missing_of = [](const char* stages) { return read(std::string(R"(<go wp="1"/>)") + stages).missing; };
    EXPECT_EQ(missing_of(R"(<circle wp="1" radius="80"/>)").size(), 1U) << "without an end";
    EXPECT_EQ(missing_of(R"(<for var="i" from="1" to="3"><go wp="2"/></for>)"),
              std::vector<std::string>{"block 'Test': not followed: loops (for)"});
    EXPECT_TRUE(missing_of(R"(<while cond="!ready"/>)").empty());
    EXPECT_TRUE(missing_of(R"(<survey_rectangle grid="50" wp1="S1" wp2="S3"/>)").empty()) << "once covers the area";
}

TEST(PlanBlocks, FlyPatternsWithTheLengthsOfTheirGeometry) {
    EXPECT_NEAR(length_m(R"(<circle wp="1" radius="80" until="NavCircleCount() @GT 2.5"/>)"), 400.0 * pi, 1e-6);
    EXPECT_NEAR(length_m(R"(<circle wp="1" radius="nav_radius" until="stage_time>100"/>)"), 1200.0, 1e-6);
    EXPECT_NEAR(length_m(R"(<oval p1="1" p2="2" radius="-50"/>)"), 600.0 + 100.0 * pi, 1e-6);
    for (const auto& [until, rounds] : {std::pair{"NavOvalCount() @GT 3", 4.0},
                                        {"nav_oval_count &gt; 0", 1.0},
                                        {"nav_oval_count &gt;= 3", 3.0},
                                        {"NavOvalCount() @GEQ 3", 3.0}})
        EXPECT_NEAR(length_m(fmt::format(R"(<oval p1="1" p2="2" radius="50" until="{}"/>)", until)),
                    rounds * (600.0 + 100.0 * pi), 1e-6)
            << until;
    EXPECT_NEAR(length_m(R"(<eight center="S1" turn_around="1" radius="50"/>)"),
                2.0 * std::hypot(200.0, 100.0) + 100.0 * pi, 1e-6);
    EXPECT_NEAR(length_m(R"x(<call fun="nav_line_run(WP_1, WP_2, 30)"/>)x"), 600.0 + 14.0 / 3.0 * pi * 30.0, 1e-6);
}

TEST(PlanBlocks, FlySurveysWithTheLengthsOfTheirLines) {
    // 400 m square: lines at 25, 75 ... 375 m; half circles of 25 m between them
    const double lines_m = 8.0 * 400.0 + 7.0 * pi * 25.0;
    EXPECT_NEAR(length_m(R"(<survey_rectangle wp1="S1" wp2="S3" grid="50"/>)"), lines_m, 1e-6);
    EXPECT_NEAR(length_m(R"(<survey_rectangle wp1="S3" wp2="S1" grid="50" orientation="WE"/>)"), lines_m, 1e-6);
    EXPECT_NEAR(length_m(R"x(<call_once fun="nav_survey_poly_osam_setup(WP_S1, 4, 50, 0)"/>)x"), lines_m, 1e-6);
    // lines in one direction: after each half circles of 60 and 85 m, and the way back
    EXPECT_NEAR(length_m(R"x(<call_once fun="nav_survey_polygon_setup(WP_S1,4,0,50,10,60,300)"/>)x"),
                15.0 * 400.0 + 7.0 * pi * (60.0 + 85.0), 1e-6);
    // 4 rounds of 7 lines: half a line first, turns of 60 and 80 m radius
    EXPECT_NEAR(length_m(R"x(<call_once fun="nav_survey_zamboni_setup(WP_S1, WP_1, 200, 40, 7, 290)"/>)x"),
                100.0 + 7.0 * 200.0 + 4.0 * pi * 60.0 + 3.0 * pi * 80.0, 1e-6);
}

TEST(PlanBlocks, StartAtTheEdgeOfTheirFirstCircle) {
    const auto plan = read(R"(<circle wp="1" radius="80" until="circle_count>1"/>)");
    EXPECT_TRUE(plan.starts_at_first_place);
    PathDefaults defaults;
    defaults.altitude_m = 260.0;
    defaults.starts_at_first_place = true;
    const auto elements = build_path(plan.entries, defaults).elements;
    ASSERT_EQ(elements.size(), 1U);
    EXPECT_TRUE(std::holds_alternative<Circles>(elements.front().shape));
}

TEST(PlanBlocks, ReportWhatIsNotFlown) {
    const auto plan = read(R"x(<exception cond="a" deroute="Land"/>
<while cond="!GpsFixValid()"/><circle wp="1" radius="50"/>
<attitude roll="0" throttle="0" vmode="throttle"/><call fun="mission_run()"/><stay wp="2"/><deroute block="Land"/>
<go wp="1" wp_qdr="90" wp_dist="50"/><eight center="1" turn_around="2" radius="20" until="stage_time>60"/><call_once fun="NavSetWaypointHere(WP_1)"/><stay/><foo/>)x");
    ASSERT_EQ(plan.not_flown.size(), 1U);
    EXPECT_EQ(plan.not_flown[0],
              "block 'Test': line 10: the circle around 1 has no end: it is flown once; "
              "line 11: <attitude> is not flown: it states no place; line 11: the hold at 2 has no time; "
              "line 12: <go> is not flown: its place is relative to a waypoint; "
              "line 12: the eight ends by a condition (stage_time>60): it is flown once; "
              "line 12: <stay> is not flown: it states no waypoint; line 12: <foo> is not flown: it states no place; "
              "not followed: deroutes to 'Land', exceptions to 'Land', loops (while), "
              "moves of waypoints by NavSetWaypointHere(WP_1), the unknown function mission_run");
}

TEST(PlanBlocks, ThatCannotBeFlownAreErrorsWithTheirPlace) {
    const auto refusal = [](const std::string& stages) { return rejected([&] { read(stages, {}); }); };
    EXPECT_EQ(refusal(R"(<circle wp="1" radius="nav_radius"/>)"),
              "p.xml:9: the radius is not known: 'nav_radius'; state the autopilot's radius of circles: radius_m in "
              "[path], --radius of `flightwatt path`");
    EXPECT_EQ(refusal(R"(<go wp="X"/>)"),
              "p.xml:9: there is no waypoint 'X'; the plan has HOME, 1, 2, S1, S2, S3, S4, low");
    EXPECT_EQ(refusal(R"(<set var="a" value="1"/>)"),
              "p.xml:9: block 'Test' has no movement that can be flown; name other blocks");
    EXPECT_EQ(refusal(R"(<survey_rectangle wp1="S1" wp2="S3" grid="0.1"/>)"),
              "p.xml:9: the spacing of lines = 0.1, expected 1 or more");
    EXPECT_NE(refusal(R"(<survey_rectangle wp1="S1" wp2="S3" grid="900"/>)").find("no lines 900 m apart fit"),
              std::string::npos);
    EXPECT_EQ(refusal(R"(<circle wp="1" radius="50" until="circle_count>1e9"/>)"),
              "p.xml:9: the number of rounds = 1000000000, expected at most 10000");
    EXPECT_EQ(rejected([] { parse_plan_blocks(plan_of(""), "p.xml", {"test"}, {}); }),
              "p.xml: there is no block 'test'; did you mean 'Test'? the plan has Test");
    EXPECT_EQ(rejected([] { parse_plan_blocks("<a/>", "p.xml", {"x"}, {}); }),
              "p.xml: has no <flight_plan> and no <procedure>; expected a flight plan of Paparazzi");
}

TEST(PlanBlocks, OfPlansThatAreMadeToHarmAreRefusedOrReported) {
    const auto reason_of = [](const std::string& stage) {
        return parse_plan(plan_of(stage), "p.xml", {60.0, 12.0}).front().not_flown.at(0);
    };
    EXPECT_NE(reason_of("<circle wp=\"1\" radius=\"" + std::string(1'000'000, '(') + "\"/>").find("is not known"),
              std::string::npos);
    EXPECT_NE(reason_of("<circle wp=\"1\" radius=\"1e300*1e300\"/>").find("is not known"), std::string::npos);
    EXPECT_NE(reason_of(R"x(<call fun="nav_survey_zamboni_setup(WP_S1, WP_1, 200, 40, 1e12, 290)"/>)x").find("5000"),
              std::string::npos);
    EXPECT_NE(reason_of(R"x(<call fun="nav_survey_polygon_setup(WP_S4,40,0,50,10,60,300)"/>)x").find("40 corners"),
              std::string::npos);
    std::string many;
    for (int i = 0; i < 10; ++i) many += R"(<oval p1="1" p2="2" radius="50" until="nav_oval_count>9000"/>)";
    EXPECT_NE(reason_of(many).find("more than 200000 movements"), std::string::npos);
    const std::string bomb = R"x(<!DOCTYPE flight_plan [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>
<flight_plan><waypoints><waypoint name="&b;" x="1e99" y="0" alt="WaypointAlt(WP_&b;)"/></waypoints>
<blocks><block name="b"><go wp="&b;"/></block></blocks></flight_plan>)x";
    EXPECT_EQ(parse_plan(bomb, "p.xml", {}).size(), 1U);
}

TEST(PlanBlocks, OfRealPlansAreFlownOrReported) {
    FLIGHTWATT_NEEDS_SHARED();
    std::size_t plans = 0, blocks = 0, flown = 0;
    for (const auto& file : std::filesystem::directory_iterator(test::shared_dir() / "plans/paparazzi")) {
        ++plans;
        for (const auto& block : parse_plan(read_file(file.path()), file.path().string(), {80.0, 12.0})) {
            ++blocks;
            if (!block.flown.empty()) ++flown;
            EXPECT_TRUE(!block.flown.empty() || block.length_m == 0.0) << block.name;
        }
    }
    EXPECT_EQ(plans, 52U);
    EXPECT_GT(flown, blocks / 3);
}

}  // namespace
}  // namespace flightwatt::path
