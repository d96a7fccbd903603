#include "path/plan_writer.h"

#include "base/atomic_file.h"
#include "helpers/test_paths.h"
#include "path/path_entries.h"
#include "path/plans/json_text.h"
#include "path/waypoint_files.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

constexpr PlanFormat formats[] = {PlanFormat::qgroundcontrol, PlanFormat::ardupilot, PlanFormat::flight_plan};

PathEntry to(double east_m, double north_m, double altitude_m) {
    PathEntry entry;
    entry.name = "to";
    entry.place = {east_m, north_m};
    entry.altitude_m = altitude_m;
    return entry;
}

PathEntry around(double east_m, double north_m, double altitude_m, double turns, double radius_m) {
    auto entry = to(east_m, north_m, altitude_m);
    entry.circles = turns;
    entry.radius_m = std::abs(radius_m);
    entry.to_right = radius_m > 0.0;
    return entry;
}

/// Lines that climb, two speeds, circles to both sides, one of them entered from within, and a wait.
PlanToWrite flight(bool waits = true) {
    std::vector<PathEntry> entries{to(0, 400, 60),
                                   to(300, 400, 90),
                                   around(900, 700, 90, 3.25, 80),
                                   to(900, 1200, 90),
                                   around(900, 1150, 80, 2, -60),
                                   to(-200, 300, 70)};
    if (waits) entries[1].hold_s = 12.0;
    entries[3].airspeed_m_per_s = 17.0;
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 14.0;
    defaults.altitude_m = 60.0;
    defaults.start = LocalPosition{30.0, -40.0};
    defaults.local_origin = {43.4622, 1.2729};
    return {"a <flight> & more", build_path(entries, defaults), *path_origin(entries, defaults)};
}

/// The plan as a mission reads it.
FlightPath read_again(const PlanToWrite& plan, PlanFormat format) {
    const auto text = write_plan(plan, format).text;
    const auto file = test::scratch_dir() / ("written" + plan_ending(format));
    write_file_atomically(file, text);
    const AutopilotSettings settings{std::nullopt, 14.0, plan.is_rotorcraft};
    const auto read = format == PlanFormat::flight_plan ? parse_plan_blocks(text, "p.xml", {written_block}, settings)
                                                        : read_waypoints(file, settings);
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 14.0;
    defaults.starts_at_first_place = read.starts_at_first_place;
    defaults.altitude_m = read.entries.front().altitude_m;
    return build_path(read.entries, defaults);
}

double length_m(const PathElement& element) {
    if (const auto* circles = std::get_if<Circles>(&element.shape))
        return 2.0 * std::numbers::pi * circles->radius_m * circles->turns;
    const auto* leg = std::get_if<Leg>(&element.shape);
    return leg != nullptr ? leg->length_m : 0.0;
}

/// Half circles of 25 m were written, which no aircraft flies in the wind: read again, they were wider.
TEST(PlanWriter, LeavesTurnsThatAreTooNarrowToTheAutopilot) {
    auto plan = flight();
    plan.path.elements.clear();
    for (int line = 0; line < 4; ++line) {
        PathElement element;
        element.airspeed_m_per_s = 14.0;
        const bool is_north = line % 2 == 0;
        element.shape = Leg{600.0, is_north ? 0.0 : 180.0};
        plan.path.elements.push_back(element);
        element.shape = Circles{25.0, 0.5, is_north, is_north ? 0.0 : 180.0};
        element.is_turn = true;
        if (line < 3) plan.path.elements.push_back(element);
    }
    plan.wind = {3.0, 200.0};
    const auto flown_m = [&](const FlightPath& path) {
        double sum_m = 0.0;
        for (const auto& element : fly_turns(path, plan.wind, plan.turns).path.elements) sum_m += length_m(element);
        return sum_m;
    };
    for (const auto format : formats)
        EXPECT_NEAR(flown_m(read_again(plan, format)), flown_m(plan.path), 0.1) << plan_ending(format);
}

/// A pack that began with the rest of a line took 5 s more as written than as planned, without a note.
TEST(PlanWriter, NotesNarrowTurnsAfterShortWays) {
    const auto notes = [](double way_m) {
        auto plan = flight();
        PathElement element;
        element.airspeed_m_per_s = 14.0;
        plan.path.elements.clear();
        for (const auto& shape : std::initializer_list<std::variant<Leg, Circles, Hold>>{
                 Leg{800.0, 90.0}, Leg{way_m, 210.0}, Circles{15.0, 0.5, false, 210.0}, Leg{600.0, 30.0}}) {
            element.shape = shape;
            element.is_turn = std::holds_alternative<Circles>(shape);
            plan.path.elements.push_back(element);
        }
        return write_plan(plan, PlanFormat::ardupilot).notes;
    };
    EXPECT_EQ(notes(35.0),
              std::vector<std::string>{
                  "narrow turns after short ways are written as corners, which are passed in another time: "
                  "simulate the written missions"});
    EXPECT_TRUE(notes(300.0).empty());
}

/// A change of height above one place was written as a hold of its time, which the autopilot waits in addition.
TEST(PlanWriter, WritesNoHoldForAChangeOfHeight) {
    auto plan = flight();
    plan.is_rotorcraft = true;
    auto& elements = plan.path.elements;
    elements.resize(1);
    elements.front().shape = Leg{500.0, 0.0};
    elements.push_back(elements.front());
    elements.back().shape = Hold{40.0};
    elements.back().altitude_change_m = 80.0;
    const auto holds = [&] {
        return write_plan(plan, PlanFormat::ardupilot).text.find("\t40.000000000000\t") != std::string::npos;
    };
    EXPECT_TRUE(holds()) << "a hold on which the height changes";
    plan.rates = {2.0, 1.5};
    EXPECT_FALSE(holds());
}

TEST(PlanWriter, WritesWhatIsReadAgain) {
    for (const bool is_rotorcraft : {false, true})
        for (const auto format : formats) {
            SCOPED_TRACE(fmt::format("{} {}", plan_ending(format), is_rotorcraft));
            auto plan = flight(is_rotorcraft || format == PlanFormat::flight_plan);
            plan.is_rotorcraft = is_rotorcraft;
            const auto again = read_again(plan, format);
            ASSERT_EQ(again.elements.size(), plan.path.elements.size());
            for (std::size_t i = 0; i < again.elements.size(); ++i) {
                const auto& expected = plan.path.elements[i];
                const auto& actual = again.elements[i];
                EXPECT_EQ(actual.shape.index(), expected.shape.index()) << i;
                EXPECT_NEAR(length_m(actual), length_m(expected), 1e-3) << i;
                EXPECT_NEAR(actual.altitude_change_m, expected.altitude_change_m, 1e-6) << i;
                if (format != PlanFormat::flight_plan) {
                    EXPECT_EQ(actual.airspeed_m_per_s, expected.airspeed_m_per_s) << i;
                }
                if (const auto* hold = std::get_if<Hold>(&actual.shape)) {
                    EXPECT_EQ(hold->time_s, std::get<Hold>(expected.shape).time_s);
                }
                const auto here = local_position_at(again, {i, 1.0});
                const auto there = local_position_at(plan.path, {i, 1.0});
                EXPECT_NEAR(std::hypot(here.east_m - there.east_m, here.north_m - there.north_m), 0.0, 0.01) << i;
            }
        }
}

/// They were those of wings, which need a runway.
TEST(PlanWriter, WritesTakeOffAndLandingOfVtols) {
    auto plan = flight(false);
    plan.is_of_vtol = true;
    const auto wpl = write_plan(plan, PlanFormat::ardupilot).text;
    EXPECT_NE(wpl.find("\n1\t0\t3\t84\t0.000000000000\t"), std::string::npos) << wpl;
    EXPECT_NE(wpl.find("\t3\t85\t"), std::string::npos);
    EXPECT_EQ(wpl.find("\t3\t21\t"), std::string::npos);
    const auto qgc = write_plan(plan, PlanFormat::qgroundcontrol).text;
    for (const auto* text : {"\"vehicleType\": 20", "\"command\": 84", "\"command\": 85"})
        EXPECT_NE(qgc.find(text), std::string::npos) << text;
    plan.is_rotorcraft = true;
    EXPECT_NE(write_plan(plan, PlanFormat::qgroundcontrol).text.find("\"cruiseSpeed\": 14"), std::string::npos)
        << "the speed that is read of a VTOL's plan";
}

TEST(PlanWriter, StatesDefaultsOfTheFormat) {
    auto plan = flight();
    plan.origin.altitude_m.reset();
    for (const auto format : formats) {
        EXPECT_NE(write_plan(plan, format).notes.front().find("50 m above the ground"), std::string::npos);
        EXPECT_EQ(write_plan(flight(false), format).notes.size(), format == PlanFormat::ardupilot ? 0U : 1U);
    }
    EXPECT_NE(write_plan(flight(false), PlanFormat::qgroundcontrol).notes.front().find("PX4 refuses"),
              std::string::npos);
}

/// Holds of wings were the time of a waypoint, which ArduPlane and PX4 ignore: the plan waited, the aircraft did not.
TEST(PlanWriter, WritesHoldsOfWingsAsCirclesForTheirTime) {
    for (const auto format : {PlanFormat::qgroundcontrol, PlanFormat::ardupilot}) {
        SCOPED_TRACE(plan_ending(format));
        const auto plan = flight();
        EXPECT_NE(write_plan(plan, format).notes.front().find("holds are written as circles"), std::string::npos);
        const auto again = read_again(plan, format).elements;
        const auto is_hold = [](const PathElement& element) {
            const bool circles = std::holds_alternative<Circles>(element.shape);
            return circles && std::abs(length_m(element) - 12.0 * 14.0) < 1e-3;
        };
        EXPECT_EQ(std::ranges::count_if(again, is_hold), 1);
        auto rotorcraft = plan;
        rotorcraft.is_rotorcraft = true;
        EXPECT_EQ(write_plan(rotorcraft, PlanFormat::ardupilot).notes.size(), 0U);
    }
    auto plan = flight();
    plan.turns.radius_m = 45.0;
    const auto text = write_plan(plan, PlanFormat::ardupilot).text;
    EXPECT_NE(text.find("\t19\t12.000000000000\t0.000000000000\t45.000000000000\t"), std::string::npos) << text;
}

TEST(PlanWriter, KeepsAltitudesAboveTheSea) {
    auto plan = flight();
    plan.origin.ground_m = 185.0;
    EXPECT_NE(write_plan(plan, PlanFormat::flight_plan).text.find("name=\"P2\" x=\"300\" y=\"400\" alt=\"275\""),
              std::string::npos)
        << write_plan(plan, PlanFormat::flight_plan).text;
    EXPECT_NE(write_plan(plan, PlanFormat::ardupilot).text.find("\t185.000000\t1\n"), std::string::npos);
    EXPECT_NE(write_plan(plan, PlanFormat::ardupilot).text.find("\t60.000000000000\t1\n"), std::string::npos);
}

/// 110 m above the sea were written as above home: at a field 60 m high they were flown 60 m higher.
TEST(PlanWriter, WritesAltitudesAboveTheSeaAsSuchWhereTheHeightOfHomeIsUnknown) {
    auto plan = flight(false);
    plan.origin.is_above_sea = true;
    const auto lines = write_plan(plan, PlanFormat::ardupilot).text;
    EXPECT_NE(lines.find("\n1\t0\t0\t22\t"), std::string::npos) << "take-off\n" << lines;
    EXPECT_NE(lines.find("\t0\t0\t16\t"), std::string::npos) << lines;
    EXPECT_EQ(lines.find("\t0\t3\t16\t"), std::string::npos) << lines;
    EXPECT_NE(lines.find("\t0\t3\t21\t"), std::string::npos) << "it lands at home\n" << lines;
    const auto json = Json::parse(write_plan(plan, PlanFormat::qgroundcontrol).text).at("mission").at("items");
    EXPECT_EQ(json.front().at("frame"), 0);
    EXPECT_EQ(json.front().at("AltitudeMode"), 2);
    EXPECT_EQ(json.back().at("frame"), 3);
    EXPECT_EQ(json.back().at("AltitudeMode"), 1);
    for (const auto format : {PlanFormat::qgroundcontrol, PlanFormat::ardupilot})
        EXPECT_NEAR(read_again(plan, format).elements.at(1).altitude_change_m,
                    plan.path.elements.at(1).altitude_change_m, 1e-6);
}

}  // namespace
}  // namespace flightwatt::path
