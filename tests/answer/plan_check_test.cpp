#include "answer/plan_check.h"

#include "base/error.h"
#include "base/input_file.h"
#include "battery/battery_toml.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

PlanQuestion question_of(const std::filesystem::path& plan) {
    const auto fits = test::source_dir() / "fits";
    PlanQuestion question;
    auto& aircraft = question.aircraft;
    aircraft.name = "plan";
    aircraft.mechanical = (fits / "mechanical" / "synthetic-wing.toml").string();
    aircraft.battery = (fits / "battery" / "synthetic-3s.toml").string();
    aircraft.model = mechanical::read_mechanical_model(aircraft.mechanical);
    aircraft.pack = battery::read_battery(aircraft.battery);
    question.plan.file = plan;
    question.plan.name = plan.string();
    question.samples = 400;
    return question;
}

/// `km` to the north, back 60 m to its east, and home.
PlanQuestion lines_of(double km) {
    const auto file = test::scratch_dir() / "lines.csv";
    test::write_text(file, fmt::format("east_m,north_m\n0,0\n0,{0}\n60,{0}\n60,0\n", km * 1000.0));
    return question_of(file);
}

TEST(PlanCheck, AnswersYesPerhapsAndNo) {
    EXPECT_EQ(check_plan(lines_of(2.0)).fit, PlanFit::yes);
    EXPECT_EQ(check_plan(lines_of(60.0)).fit, PlanFit::no);
    double km = 10.0;
    auto check = check_plan(lines_of(km));
    while (check.fit == PlanFit::yes && km < 60.0) check = check_plan(lines_of(km += 0.5));
    EXPECT_EQ(check.fit, PlanFit::perhaps);
    EXPECT_LT(*check.probability, 0.95);
    EXPECT_TRUE(check.flown->keeps_reserve);
}

TEST(PlanCheck, AddsUpItsLegs) {
    const auto check = check_plan(lines_of(3.0));
    ASSERT_GE(check.legs.size(), 3U);
    double energy_wh = 0.0;
    double at_s = check.legs.front().start_s;
    double soc_percent = 100.0;
    for (const auto& leg : check.legs) {
        EXPECT_NEAR(leg.start_s, at_s, 1e-6);
        at_s += leg.duration_s;
        EXPECT_LT(leg.soc_percent, soc_percent);
        soc_percent = leg.soc_percent;
        energy_wh += leg.energy_wh;
    }
    EXPECT_NEAR(*check.length_m, 6060.0, 0.02 * 6060.0);
    EXPECT_GT(check.legs.back().soc_percent, *check.flown->final_soc_percent);
    EXPECT_LT(energy_wh, check.flown->mechanical_energy_wh);
}

TEST(PlanCheck, NamesTheLegOnWhichItFails) {
    const auto check = check_plan(lines_of(60.0));
    ASSERT_TRUE(check.fails_at);
    const auto leg = std::ranges::find(check.legs, *check.fails_at, &PlanLeg::name);
    ASSERT_NE(leg, check.legs.end());
    EXPECT_LT(leg->soc_percent, 20.0);
    EXPECT_TRUE(leg == check.legs.begin() || std::prev(leg)->soc_percent >= 20.0);
}

/// Each remedy that suffices does so when it is asked for.
TEST(PlanCheck, HelpsWithWhatSuffices) {
    const auto question = lines_of(30.0);
    const auto check = check_plan(question);
    ASSERT_NE(check.fit, PlanFit::yes);
    const auto kinds = [](const char* kind) { return Contains(Field(&PlanRemedy::kind, kind)); };
    EXPECT_THAT(check.remedies, kinds("pack"));
    EXPECT_THAT(check.remedies, kinds("part"));
    EXPECT_THAT(check.remedies, kinds("airspeed"));
    for (const auto& remedy : check.remedies) {
        auto changed = question;
        if (remedy.kind == "airspeed") changed.plan.airspeed_m_per_s = remedy.value;
        if (remedy.kind == "part" || remedy.kind == "pack") continue;
        const auto again = check_plan(changed);
        EXPECT_EQ(again.fit == PlanFit::yes, remedy.suffices) << remedy.text;
        EXPECT_DOUBLE_EQ(again.probability.value(), remedy.probability.value()) << remedy.text;
    }
    auto pack = std::ranges::find(check.remedies, "pack", &PlanRemedy::kind);
    EXPECT_GE(pack->probability.value(), 0.93);  // by other drawn flights
}

TEST(PlanCheck, HelpsWithFewerLinesOverAnArea) {
    const auto file = test::scratch_dir() / "area.geojson";
    test::write_text(file, R"({"type": "Polygon", "coordinates": [[[1.27, 43.46], [1.29, 43.46], [1.29, 43.48],
        [1.27, 43.48], [1.27, 43.46]]]})");
    auto question = question_of(file);
    question.plan.spacing_m = 40.0;
    const auto check = check_plan(question);
    ASSERT_EQ(check.fit, PlanFit::no);
    EXPECT_THAT(check.chosen, Contains("spacing_m = 40, as asked"));
    const auto wider = std::ranges::find(check.remedies, "spacing", &PlanRemedy::kind);
    ASSERT_NE(wider, check.remedies.end());
    EXPECT_TRUE(wider->suffices);
    question.plan.spacing_m = wider->value;
    EXPECT_EQ(check_plan(question).fit, PlanFit::yes);
    question.plan.spacing_m = 0.8 * wider->value;
    EXPECT_NE(check_plan(question).fit, PlanFit::yes) << "lines as close as suffices";
    auto lines = lines_of(2.0);
    lines.plan.spacing_m = 40.0;
    EXPECT_THROW(check_plan(lines), UsageError) << "no area";
}

TEST(PlanCheck, IsNoInAWindThatForbidsIt) {
    auto question = lines_of(1.0);
    question.aircraft.wind = path::Wind{30.0, 0.0};
    const auto check = check_plan(question);
    EXPECT_EQ(check.fit, PlanFit::no);
    EXPECT_THAT(check.reason, HasSubstr("the wind of 30 m/s"));
}

/// Two waypoints of QGroundControl and one more item.
PlanCheck check_with(const std::string& command_and_parameters) {
    const auto file = test::scratch_dir() / "items.plan";
    const auto item = [](const std::string& text) {
        return fmt::format(R"({{"type": "SimpleItem", "frame": 3, {}}})", text);
    };
    test::write_text(file, fmt::format(R"({{"fileType": "Plan", "version": 1, "mission": {{"version": 2,
"plannedHomePosition": [43.46, 1.27, 100], "items": [{}, {}, {}]}}}})",
                                       item(R"("command": 16, "params": [0, 0, 0, null, 43.47, 1.27, 60])"),
                                       item(R"("command": 16, "params": [0, 0, 0, null, 43.47, 1.28, 60])"),
                                       item(command_and_parameters)));
    return check_plan(question_of(file));
}

TEST(PlanCheck, IsPerhapsAtMostWhereAMovementIsNotFlown) {
    const auto endless = check_with(R"("command": 177, "params": [1, -1, 0, 0, 0, 0, 0])");
    EXPECT_EQ(endless.fit, PlanFit::perhaps);
    EXPECT_GE(endless.probability.value(), 0.95);
    EXPECT_THAT(endless.flown->uncertain,
                ElementsAre("the plan is not flown as it is: item 3: the jump to item 1 is not flown: it has no end"));
    EXPECT_THAT(endless.reason, HasSubstr("the jump to item 1"));
    EXPECT_TRUE(endless.remedies.empty()) << "what is flown fits";
    const auto once = check_with(R"("command": 177, "params": [1, 1, 0, 0, 0, 0, 0])");
    EXPECT_EQ(once.fit, PlanFit::yes);
    EXPECT_GT(*once.length_m, 1.5 * *endless.length_m);
    EXPECT_EQ(check_with(R"("command": 177, "params": [1, 500, 0, 0, 0, 0, 0])").fit, PlanFit::no);
}

TEST(PlanCheck, IsPerhapsAtMostFarBeyondWhatTheFlightsFlew) {
    auto question = lines_of(1.0);
    EXPECT_EQ(check_plan(question).fit, PlanFit::yes);
    question.plan.airspeed_m_per_s = 23.0;
    const auto fast = check_plan(question);
    EXPECT_EQ(fast.fit, PlanFit::perhaps);
    EXPECT_THAT(fast.reason, HasSubstr("% of the cruise is flown far beyond the airspeeds and climbs"));
    const auto climb = test::scratch_dir() / "climb.csv";
    test::write_text(climb, "east_m,north_m,altitude_m\n0,0,50\n0,400,1000\n0,2000,1000\n");
    EXPECT_EQ(check_plan(question_of(climb)).fit, PlanFit::perhaps);
}

TEST(PlanCheck, IsPerhapsAtMostWithThePackOfAnotherAircraft) {
    auto question = lines_of(1.0);
    auto model = read_file(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    const auto file = question.plan.file.parent_path() / "six_cells.toml";
    test::write_text(file, model.insert(model.find("name ="), "pack_voltage_v = 25.2\n"));
    question.aircraft.mechanical = file.string();
    const auto check = check_plan(question);
    EXPECT_EQ(check.fit, PlanFit::perhaps);
    EXPECT_THAT(check.reason, HasSubstr("has it another number of cells?"));
}

TEST(PlanCheck, FliesOneAirspeedInsteadOfThePlansChanges) {
    const auto file = test::scratch_dir() / "speeds.csv";
    test::write_text(file, "east_m,north_m,airspeed_m_per_s\n0,0,\n0,24000,16\n200,24000,16\n200,0,16\n");
    auto question = question_of(file);
    const auto planned = check_plan(question);
    EXPECT_THAT(planned.chosen, Contains(HasSubstr("changes its airspeed to 16 m/s; --airspeed states one")));
    const auto slower = std::ranges::find(planned.remedies, "airspeed", &PlanRemedy::kind);
    ASSERT_NE(slower, planned.remedies.end());
    question.plan.airspeed_m_per_s = 12.0;
    const auto slow = check_plan(question);
    EXPECT_THAT(slow.chosen, Contains("one_airspeed = true: 12 m/s instead of the plan's 16 m/s"));
    EXPECT_GT(slow.flown->duration_s, 1.2 * planned.flown->duration_s);
}

/// Over its start, a part of the path ends at a height from which the way back is too steep.
TEST(PlanCheck, AnswersWhereAPartOfThePathCannotBeFlown) {
    const auto file = test::scratch_dir() / "over.csv";
    test::write_text(file, "east_m,north_m,altitude_m\n0,0,20\n0,20000,300\n0,0,300\n0,-20000,300\n0,0,20\n");
    const auto check = check_plan(question_of(file));
    EXPECT_EQ(check.fit, PlanFit::no);
    EXPECT_THAT(check.remedies, Contains(Field(&PlanRemedy::kind, "pack")));
}

/// Those lines, of a rotorcraft that takes 24 W at each speed.
PlanQuestion rotorcraft_lines_of(double km) {
    auto question = lines_of(km);
    auto text = read_file(question.aircraft.mechanical);
    const std::string drag = "term = \"drag\"\ncoefficient = 0.0095";
    text.replace(text.find(drag), drag.size(), "term = \"constant\"\ncoefficient = 24.0");
    text.insert(text.find("[takeoff]"), "rotorcraft = true\n");
    const auto model = question.plan.file.parent_path() / "rotorcraft.toml";
    test::write_text(model, text);
    question.aircraft.mechanical = model.string();
    question.aircraft.model = mechanical::read_mechanical_model(model);
    return question;
}

/// A rotorcraft's autopilot keeps the speed over ground: a wind above it was "no".
TEST(PlanCheck, OfARotorcraftTakesAsLongInWind) {
    auto question = rotorcraft_lines_of(1.0);
    question.plan.airspeed_m_per_s = 12.0;
    const auto calm = check_plan(question);
    question.aircraft.wind = {6.0, 0.0};
    const auto windy = check_plan(question);
    EXPECT_NE(windy.fit, PlanFit::no);
    EXPECT_NEAR(windy.flown->duration_s, calm.flown->duration_s, 1e-6);
    question.aircraft.wind = {14.0, 0.0};
    const auto stormy = check_plan(question);
    EXPECT_EQ(stormy.fit, PlanFit::perhaps) << "at 26 m/s through the air its power is unknown";
    EXPECT_FALSE(stormy.flown);
    EXPECT_FALSE(stormy.length_m);
    EXPECT_THAT(stormy.reason, HasSubstr("26 m/s is beyond what the model's flights flew"));
}

/// Such a speed was "enough", and the answer with it "perhaps".
TEST(PlanCheck, IsNotHelpedByASpeedOfUncertainPower) {
    auto question = rotorcraft_lines_of(6.0);
    question.aircraft.reserve_soc_percent = 79.0;
    question.aircraft.wind = {5.0, 0.0};
    question.plan.airspeed_m_per_s = 11.0;
    const auto check = check_plan(question);
    EXPECT_TRUE(check.flown->uncertain.empty());
    const auto faster = std::ranges::find(check.remedies, "airspeed", &PlanRemedy::kind);
    ASSERT_NE(faster, check.remedies.end());
    EXPECT_FALSE(faster->suffices);
    EXPECT_THAT(faster->text, HasSubstr("(uncertain: "));
    question.plan.airspeed_m_per_s = faster->value;
    EXPECT_EQ(check_plan(question).fit, PlanFit::perhaps);
}

TEST(PlanCheck, OfATimeThatTheSpeedDoesNotGiveIsUncertain) {
    const auto file = test::scratch_dir() / "fast.csv";
    const auto check_of = [&](int seconds) {
        test::write_text(file, fmt::format("east_m,north_m,duration_s\n0,0,\n600,0,{}\n", seconds));
        auto question = question_of(file);
        question.plan.airspeed_m_per_s = 13.0;
        return check_plan(question);
    };
    EXPECT_EQ(check_of(40).fit, PlanFit::yes) << "15 m/s";
    const auto fast = check_of(20);
    EXPECT_EQ(fast.fit, PlanFit::perhaps);
    EXPECT_THAT(fast.reason, HasSubstr("600 m in 20 s are 30 m/s over ground"));
}

/// 16 times the spacing does not fit into the area, and no wider lines were offered; a MultiPolygon was no area.
TEST(PlanCheck, HelpsWithFewerLinesOverANarrowArea) {
    const auto file = test::scratch_dir() / "narrow.geojson";
    test::write_text(file, R"({"type": "MultiPolygon", "coordinates": [[[[1.27, 43.40], [1.2733, 43.40],
        [1.2733, 43.51], [1.27, 43.51], [1.27, 43.40]]]]})");
    auto question = question_of(file);
    question.plan.spacing_m = 40.0;
    const auto check = check_plan(question);
    ASSERT_EQ(check.fit, PlanFit::no);
    const auto wider = std::ranges::find(check.remedies, "spacing", &PlanRemedy::kind);
    ASSERT_NE(wider, check.remedies.end());
    EXPECT_TRUE(wider->suffices);
    question.plan.spacing_m = wider->value;
    EXPECT_EQ(check_plan(question).fit, PlanFit::yes);
}

/// Tiles of the terrain were ignored with an area, even where there is no such folder.
TEST(PlanCheck, RefusesTheTerrainOfAnArea) {
    auto question = question_of(test::source_dir() / "missions" / "synthetic" / "field.geojson");
    question.plan.terrain = "srtm";
    EXPECT_THROW(check_plan(question), UsageError);
}

TEST(PlanCheck, RefusesAPathAndAnAreaInOneFile) {
    const auto file = test::scratch_dir() / "both.kml";
    test::write_text(file, R"(<?xml version="1.0"?><kml><Placemark><LineString><coordinates>1.27,43.46 1.27,43.50
</coordinates></LineString></Placemark><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>1.27,43.46
1.274,43.46 1.274,43.463 1.27,43.463 1.27,43.46</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>
</kml>)");
    EXPECT_THAT(test::rejected([&] { check_plan(question_of(file)); }),
                HasSubstr("has a path (LineString) and an area (Polygon); save the one"));
}

TEST(PlanCheck, CountsTheWayFromHomeAndBack) {
    const auto file = test::scratch_dir() / "lines.csv";
    test::write_text(file, "latitude_deg,longitude_deg\n43.46,1.27\n43.47,1.27\n");
    auto question = question_of(file);
    const double alone_m = *check_plan(question).length_m;
    question.plan.home = path::GeodeticPosition{43.45, 1.27};
    EXPECT_NEAR(*check_plan(question).length_m - alone_m, 2.0 * 1111.0, 30.0);
}

/// A plan from home, with these items.
PlanQuestion items_of(const std::string& items) {
    const auto file = test::scratch_dir() / "q.plan";
    test::write_text(file, R"({"fileType": "Plan", "version": 1, "mission": {"version": 2, "vehicleType": 1,
"cruiseSpeed": 13, "plannedHomePosition": [47.0, 8.0, 100], "items": [)" +
                               items + "]}}");
    return question_of(file);
}

std::string item(int command, double latitude_deg, double altitude_m) {
    return fmt::format(R"({{"type": "SimpleItem", "command": {}, "frame": 3, "params": [0, 0, 0, 0, {}, 8.0, {}]}})",
                       command, latitude_deg, altitude_m);
}

TEST(PlanCheck, IsPerhapsAtAHeightThatTheFlightsDidNotShow) {
    const auto at = [](double height_m) {
        return check_plan(items_of(item(22, 47.0, height_m) + "," + item(16, 47.01, height_m)));
    };
    EXPECT_EQ(at(100.0).fit, PlanFit::yes);
    const auto high = at(500.0);
    EXPECT_EQ(high.fit, PlanFit::perhaps);
    EXPECT_THAT(high.reason, HasSubstr("higher than the model's flights"));
    EXPECT_THAT(high.remedies, testing::IsEmpty());
    EXPECT_NEAR(high.flown->duration_s - at(100.0).flown->duration_s, 380.0 / 4.0 + 380.0 / 2.4, 1.0);
}

TEST(PlanCheck, DoesNotReturnFromALandingElsewhere) {
    const auto way = item(16, 47.01, 50.0);
    const auto there = check_plan(items_of(way + "," + item(21, 47.02, 0.0)));
    EXPECT_NEAR(*there.length_m, 2.0 * 1111.8, 20.0);
    EXPECT_THAT(there.chosen, Contains("no return to the start: the plan ends with a landing"));
    EXPECT_NEAR(*check_plan(items_of(way)).length_m, 2.0 * 1111.8, 200.0) << "and back";
}

TEST(PlanCheck, BeginsBlocksAtTheirHome) {
    const auto length_m = [](const std::string& home) {
        const auto file = test::scratch_dir() / "plan.xml";
        test::write_text(file, fmt::format(R"(<flight_plan lat0="43.46" lon0="1.27" ground_alt="185" alt="260">
<waypoints>{}<waypoint name="1" x="0" y="1000"/><waypoint name="2" x="0" y="3000"/></waypoints>
<blocks><block name="A"><go wp="1"/><go wp="2" from="1" hmode="route"/></block></blocks></flight_plan>)",
                                           home));
        return *check_plan(question_of(file)).length_m;
    };
    EXPECT_NEAR(length_m(R"(<waypoint name="HOME" x="0" y="0"/>)") - length_m(""), 2.0 * 1000.0, 30.0);
}

TEST(PlanCheck, RefusesAPlanThatCannotBeRead) {
    const auto file = test::scratch_dir() / "empty.csv";
    test::write_text(file, "east_m,north_m\n");
    EXPECT_THROW(check_plan(question_of(file)), InputError);
}

}  // namespace
}  // namespace flightwatt::answer
