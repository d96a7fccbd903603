#include "mission/packs.h"

#include "base/units.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"
#include "mission/plan.h"
#include "mission/sampled_flights.h"
#include "path/plan_writer.h"

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;

MissionVariant read(const std::string& text) {
    return parse_mission(text, test::source_dir() / "packs.toml", {.allow_unplanned = true});
}

const std::string wing = R"(
mechanical = "fits/mechanical/synthetic-wing.toml"
battery = "fits/battery/synthetic-3s.toml"
capacity_ah = 0.6
cutoff_voltage_v = 10
reserve_soc_percent = 20
)";

/// What each hand-written mission computes, and the flights of the mission over several packs next to it.
void expect_equal(const PackFlights& all, const std::vector<std::string>& missions) {
    ASSERT_EQ(all.flights.size(), missions.size());
    EXPECT_TRUE(all.suffice) << describe(all);
    double start_s = 0.0;
    double energy_wh = 0.0;
    std::size_t row = 0;
    for (std::size_t i = 0; i < missions.size(); ++i) {
        SCOPED_TRACE(missions[i]);
        const auto one = simulate(std::get<Mission>(read(missions[i])));
        const auto& summary = all.flights[i].flown.simulation.summary;
        EXPECT_NEAR(all.flights[i].start_s, start_s, 1e-6);
        EXPECT_NEAR(summary.duration_s, one.summary.duration_s, 1e-6);
        EXPECT_NEAR(summary.energy_wh, one.summary.energy_wh, 1e-8);
        EXPECT_NEAR(summary.compute_energy_wh, one.summary.compute_energy_wh, 1e-8);
        EXPECT_NEAR(*summary.final_soc_percent, *one.summary.final_soc_percent, 1e-6);
        if (i > 0 && all.setup.packs->change_s > 0.0) {
            for (const double time_s : {start_s - all.setup.packs->change_s, start_s}) {
                const auto& rests = all.curve.rows.at(row++);
                EXPECT_NEAR(rests.time_s, time_s, 1e-6);
                EXPECT_EQ(rests.power_w + rests.mechanical_w + rests.compute_w + rests.current_a, 0.0);
            }
            EXPECT_EQ(all.curve.rows.at(row - 2).soc_percent, all.curve.rows.at(row - 3).soc_percent)
                << "the landed pack";
            EXPECT_EQ(all.curve.rows.at(row - 1).soc_percent, one.curve.rows.front().soc_percent) << "the next one";
        }
        ASSERT_LE(row + one.curve.rows.size(), all.curve.rows.size());
        for (const auto& expected : one.curve.rows) {
            const auto& actual = all.curve.rows[row++];
            ASSERT_NEAR(actual.time_s, start_s + expected.time_s, 1e-6);
            ASSERT_NEAR(actual.soc_percent, expected.soc_percent, 1e-6) << expected.time_s;
            ASSERT_NEAR(actual.power_w, expected.power_w, 1e-5) << expected.time_s;
        }
        energy_wh += one.summary.energy_wh;
        start_s += one.summary.duration_s + all.setup.packs->change_s;
    }
    EXPECT_EQ(row, all.curve.rows.size());
    EXPECT_NEAR(all.total.energy_wh, energy_wh, 1e-8);
    double area_j = 0.0;
    for (std::size_t i = 1; i < all.curve.rows.size(); ++i) {
        const auto& [from, to] = std::tie(all.curve.rows[i - 1], all.curve.rows[i]);
        area_j += (to.time_s - from.time_s) * (from.power_w + to.power_w) / 2.0;
    }
    EXPECT_NEAR(units::wh_from_joule(area_j), energy_wh, 1e-3 * energy_wh) << "the rows, as straight lines";
    EXPECT_NEAR(all.total.duration_s, start_s - all.setup.packs->change_s, 1e-6);
}

/// The paper's aircraft, and its pack, with two components and a part of the cruise in which more runs.
TEST(PackFlights, AreThreeMissionsFlownOneAfterTheOther) {
    const std::string paper = R"(
mechanical = "fits/mechanical/opterra-table1.toml"
battery = "fits/battery/paper.toml"
reserve_soc_percent = 5
[components.detection]
profile = "fits/compute/tx2-detection.csv"
)";
    const std::string ends = R"(
[[schedule]]
phase = "takeoff"
run = {}
[[schedule]]
phase = "landing"
run = {}
)";
    const auto runs = [](double from_s, double to_s, const char* fps) {
        return fmt::format(
            "[[schedule]]\nphase = \"cruise\"\nfrom = {:.17g}\nto = {:.17g}\nrun = {{ detection = {{ fps "
            "= {} }} }}\n",
            from_s, to_s, fps);
    };
    const auto all =
        fly_packs(read("duration_s = { cruise = 1500 }\n" + paper + "[packs]\ncount = 3\nchange_s = 240\n" + ends +
                       runs(0, 700, "10") + runs(700, 900, "32") + runs(900, 1500, "10")));
    ASSERT_EQ(all.flights.size(), 3U);
    const double first_s = all.flights[0].cruise_to_s;
    const double second_s = all.flights[1].cruise_to_s;
    ASSERT_TRUE(first_s < 700.0 && second_s > 900.0);
    const auto flight = [&](double cruise_s) { return fmt::format("duration_s = {{ cruise = {:.17g} }}\n", cruise_s); };
    const double middle_s = second_s - first_s;
    expect_equal(all, {flight(first_s) + paper + ends + runs(0, first_s, "10"),
                       flight(middle_s) + paper + ends + runs(0, 700 - first_s, "10") +
                           runs(700 - first_s, 900 - first_s, "32") + runs(900 - first_s, middle_s, "10"),
                       flight(1500 - second_s) + paper + ends + runs(0, 1500 - second_s, "10")});
}

struct Waypoint {
    double east_m = 0.0, north_m = 0.0, altitude_m = 0.0;
};

std::string leg(const Waypoint& to) {
    return fmt::format("[[path.leg]]\neast_m = {:.17g}\nnorth_m = {:.17g}\naltitude_m = {:.17g}\n", to.east_m,
                       to.north_m, to.altitude_m);
}

/// Lines in wind, some of which climb, from a home next to them.
TEST(PackFlights, OnAPathAreThreeMissionsWithTheWaysHome) {
    const std::vector<Waypoint> places{{0, 0, 90},    {4000, 0, 90},    {4000, 300, 90},  {0, 300, 120},
                                       {0, 600, 120}, {4000, 600, 150}, {4000, 900, 150}, {0, 900, 150},
                                       {0, 1200, 90}, {4000, 1200, 70}};
    const Waypoint home{300, -200, 90};
    const auto path_from = [](const Waypoint& start) {
        return fmt::format("[path]\nairspeed_m_per_s = 13\naltitude_m = 90\nstart = {{ east_m = {}, north_m = {} }}\n",
                           start.east_m, start.north_m);
    };
    const std::string windy = wing + "[wind]\nspeed_m_per_s = 4\nfrom_deg = 250\n";
    auto whole =
        windy + "[packs]\ncount = 4\nchange_s = 60\nhome = { east_m = 300, north_m = -200 }\n" + path_from(places[0]);
    for (std::size_t i = 1; i < places.size(); ++i) whole += leg(places[i]);
    const auto all = fly_packs(read(whole));
    ASSERT_EQ(all.flights.size(), 3U);
    std::vector<std::string> missions;
    std::size_t next = 1;  // place
    auto from = places[0];
    for (const auto& flight : all.flights) {
        auto text = windy + path_from(missions.empty() ? from : home) + (missions.empty() ? "" : leg(from));
        if (flight.return_from.empty()) {
            for (; next < places.size(); ++next) text += leg(places[next]);
        } else {
            for (const auto last = std::stoul(flight.return_from.substr(4)); next < last; ++next)
                text += leg(places[next]);
            const auto &before = places[next - 1], &after = places[next];
            from = {*flight.return_east_m, *flight.return_north_m, 0.0};
            const double part = std::hypot(from.east_m - before.east_m, from.north_m - before.north_m) /
                                std::hypot(after.east_m - before.east_m, after.north_m - before.north_m);
            from.altitude_m = std::lerp(before.altitude_m, after.altitude_m, part);
            text += leg(from) + leg(home);
        }
        missions.push_back(text);
    }
    expect_equal(all, missions);
}

/// Circles, holds and the survey of a flight plan: nothing of the path is lost or flown twice.
TEST(PackFlights, FlyAllOfAFlightPlan) {
    const auto whole = wing + R"([path]
airspeed_m_per_s = 13
flight_plan = "missions/synthetic/flight-plan.xml"
blocks = ["Oval 1-2", "Survey", "Standby", "Survey"]
radius_m = 70
return_to_start = true
[[path.leg]]
hold_s = 900
[[path.leg]]
east_m = 900
north_m = 900
circles = 40
radius_m = 80
[wind]
speed_m_per_s = 5
from_deg = 30
)";
    const auto at_once = std::get<Mission>(read(whole)).setup.cruise_path->plan->path;
    const auto all = fly_packs(read(whole + "[packs]\ncount = 9\nchange_s = 60\n"));
    ASSERT_TRUE(all.suffice) << describe(all);
    ASSERT_GT(all.flights.size(), 1U);
    const auto sums = [](const path::FlightPath& path, auto& turns, auto& hold_s, auto& height_m) {
        double length_m = 0.0;
        for (const auto& element : path.elements) {
            if (element.name == "way home" || element.name == "way to the path") continue;
            height_m += element.altitude_change_m;
            if (const auto* leg = std::get_if<path::Leg>(&element.shape)) length_m += leg->length_m;
            if (const auto* circles = std::get_if<path::Circles>(&element.shape)) turns += circles->turns;
            if (const auto* hold = std::get_if<path::Hold>(&element.shape)) hold_s += hold->time_s;
        }
        return length_m;
    };
    double turns = 0.0, hold_s = 0.0, height_m = 0.0, flown_m = 0.0;
    const double length_m = sums(at_once, turns, hold_s, height_m);
    for (const auto& flight : all.flights) {
        const auto& setup = setup_of(flight.mission);
        double flown_turns = 0.0, flown_hold_s = 0.0, flown_height_m = 0.0;
        flown_m += sums(setup.cruise_path->plan->path, flown_turns, flown_hold_s, flown_height_m);
        turns -= flown_turns;
        hold_s -= flown_hold_s;
        height_m -= flown_height_m;
        double change_m = 0.0;  // every flight ends at the height that it began at
        for (const auto& element : setup.cruise_path->plan->path.elements) change_m += element.altitude_change_m;
        EXPECT_NEAR(change_m, 0.0, 1e-6);
        const auto& elements = setup.cruise_path->plan->path.elements;
        const auto end = path::local_position_at(path::FlightPath{elements}, {elements.size(), 0.0});
        EXPECT_NEAR(std::hypot(end.east_m, end.north_m), 0.0, 1e-6 * flown_m);  // from home, and back
    }
    // Each flight turns onto its part of the path and off it, and cuts other corners than the whole.
    EXPECT_NEAR(flown_m, length_m, 0.01 * length_m);
    EXPECT_NEAR(turns, 0.0, 1.0);
    EXPECT_NEAR(hold_s, 0.0, 1e-6);
    EXPECT_NEAR(height_m, 0.0, 1e-6);
}

/// What the file of a flight's plan costs, read as a mission.
double soc_of_written(const PackFlight& flight, const std::string& keys) {
    const auto& setup = setup_of(flight.mission);
    const auto& plan = *setup.cruise_path->plan;
    const auto file = test::scratch_dir() / fmt::format("pack-{}.plan", flight.pack);
    const auto written = write_plan(
        {setup.name, drawn_path(plan), *plan.origin, setup.mechanical->is_rotorcraft, *plan.turns, plan.wind},
        path::PlanFormat::qgroundcontrol);
    test::write_text(file, written.text);
    const auto again = read(fmt::format("{}[path]\nairspeed_m_per_s = 13\nwaypoints = '{}'\n", keys, file.string()));
    return *simulate(std::get<Mission>(again)).summary.final_soc_percent;
}

/// A path that begins at 400 m above home and ends at 20 m: its packs fly home at 400 m, and the landing of each was
/// counted from 20 m. The model's flights climbed to 120 m in 30 s, and descend at 2.4 m/s.
TEST(PackFlights, TakeOffAndLandByTheHeightsOfTheirOwnEnds) {
    std::string plan = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t47\t8\t0\t1\n";
    const auto add = [&](int command, double latitude_deg, double altitude_m) {
        plan += fmt::format("1\t0\t3\t{}\t0\t0\t0\t0\t{}\t8\t{}\t1\n", command, latitude_deg, altitude_m);
    };
    add(22, 47.0, 400.0);
    for (const double latitude_deg : {47.03, 47.0, 47.03, 47.0, 47.03}) add(16, latitude_deg, 400.0);
    add(16, 47.0, 20.0);
    const auto file = test::scratch_dir() / "high.waypoints";
    test::write_text(file, plan);
    const std::string keys =
        "mechanical = \"fits/mechanical/synthetic-wing.toml\"\nbattery = "
        "\"fits/battery/synthetic-3s.toml\"\ncapacity_ah = 1\nreserve_soc_percent = 20\n";
    const auto all = fly_packs(read(keys + "[packs]\ncount = 9\nchange_s = 60\n[path]\nairspeed_m_per_s = 13\n" +
                                    fmt::format("waypoints = '{}'\n", file.string())));
    ASSERT_TRUE(all.suffice) << describe(all);
    ASSERT_GT(all.flights.size(), 1U);
    for (const auto& flight : all.flights) {
        const auto& duration_s = setup_of(flight.mission).duration_s;
        EXPECT_NEAR(duration_s[Phase::takeoff], 30.0 + 280.0 / 4.0, 1e-6);
        EXPECT_NEAR(duration_s[Phase::landing], flight.return_from.empty() ? 50.0 : 50.0 + 280.0 / 2.4, 1e-6);
        const auto& summary = flight.flown.simulation.summary;
        EXPECT_GE(*summary.final_soc_percent, 20.0);
        EXPECT_NEAR(soc_of_written(flight, keys), *summary.final_soc_percent, 0.01);
    }
}

/// A way home of 40 m lost 200 m of height at the airspeed: what the descent takes was missing.
TEST(PackFlights, ChangeLargeHeightsAboveHome) {
    std::string legs =
        "[[path.leg]]\nlength_m = 2000\ncourse_deg = 0\naltitude_m = 290\n"
        "[[path.leg]]\nlength_m = 1960\ncourse_deg = 180\n";
    for (int line = 0; line < 20; ++line)
        legs += fmt::format("[[path.leg]]\nlength_m = 900\ncourse_deg = {}\n", line % 2 == 0 ? 90 : 270);
    const auto all = fly_packs(read(wing +
                                    "[packs]\ncount = 20\nchange_s = 60\n[path]\nairspeed_m_per_s = 13\n"
                                    "altitude_m = 90\nstart = { latitude_deg = 47, longitude_deg = 8 }\n" +
                                    legs));
    ASSERT_TRUE(all.suffice) << describe(all);
    ASSERT_GT(all.flights.size(), 1U);
    for (const auto& flight : all.flights) {
        const auto& elements = drawn_path(*setup_of(flight.mission).cruise_path->plan).elements;
        const auto height_s = [](const path::PathElement& element) {
            return std::get<path::Hold>(element.shape).time_s;  // the model's flights climb at 4 m/s, descend at 2.4
        };
        if (flight.pack > 1) {
            EXPECT_NEAR(height_s(elements.front()), 200.0 / 4.0, 1e-9);
        }
        if (flight.return_from.empty()) continue;
        EXPECT_NEAR(height_s(elements.back()), 200.0 / 2.4, 1e-9);
        EXPECT_EQ(elements.at(elements.size() - 2).altitude_change_m, 0.0);
    }
    const auto& first = all.flights.front();
    EXPECT_NEAR(soc_of_written(first, wing), *first.flown.simulation.summary.final_soc_percent, 0.01);
}

TEST(PackFlights, AreTheFewestAndShareTheChargeEvenly) {
    const auto text = [](int count) {
        return "duration_s = { cruise = 3000 }\n" + wing + fmt::format("[packs]\ncount = {}\nchange_s = 60\n", count);
    };
    const auto all = fly_packs(read(text(5)));
    ASSERT_TRUE(all.suffice);
    ASSERT_GT(all.flights.size(), 1U);
    EXPECT_EQ(*all.needed, all.flights.size());
    for (const auto& flight : all.flights) {
        EXPECT_NEAR(*flight.flown.simulation.summary.final_soc_percent, *all.total.final_soc_percent, 0.5);
        EXPECT_GE(flight.largest_to_s, flight.cruise_to_s);
    }
    EXPECT_NEAR(all.flights.front().cruise_to_s, 3000.0 / static_cast<double>(all.flights.size()), 30.0);
    // One pack fewer cannot do it: the flights go as far as they can.
    const auto fewer = fly_packs(read(text(static_cast<int>(all.flights.size()) - 1)));
    EXPECT_FALSE(fewer.suffice);
    EXPECT_EQ(fewer.needed, all.needed);
    for (const auto& flight : fewer.flights) {
        EXPECT_NEAR(*flight.flown.simulation.summary.final_soc_percent, 20.0, 0.01);
        EXPECT_EQ(flight.largest_to_s, flight.cruise_to_s);
    }
    EXPECT_NE(describe(fewer).find(fmt::format("{} packs would do", *all.needed)), std::string::npos);
}

TEST(PackFlights, HaveTheirOwnPacks) {
    const auto all =
        fly_packs(read("duration_s = { cruise = 4000 }\nreserve_soc_percent = 20\nmechanical = "
                       "\"fits/mechanical/synthetic-wing.toml\"\nbattery = "
                       "\"fits/battery/synthetic-3s.toml\"\n[packs]\ncount = 2\nchange_s = 60\nbattery = "
                       "[\"fits/battery/paper.toml\", \"fits/battery/synthetic-3s.toml\"]\n"));
    ASSERT_EQ(all.flights.size(), 2U);
    EXPECT_EQ(setup_of(all.flights[0].mission).battery.voltage_v, 3.416);
    EXPECT_TRUE(setup_of(all.flights[1].mission).battery.thevenin);
    EXPECT_LT(all.flights[0].cruise_to_s, 1500.0);  // a third of the energy
}

TEST(PackFlights, AreNotPossibleWhereNoPackGetsFurther) {
    const auto all = fly_packs(read(wing + "[packs]\ncount = 3\nchange_s = 60\n[path]\nairspeed_m_per_s = 13\n" +
                                    "[[path.leg]]\nlength_m = 60000\ncourse_deg = 0\n"));
    EXPECT_FALSE(all.suffice);
    EXPECT_FALSE(all.needed);
    EXPECT_NE(describe(all).find("no number of packs would do"), std::string::npos) << describe(all);
}

/// Of 200 parts of such a cruise, 200 times the difference leaves 1e-12 s: a step of output was refused that was not
/// asked for, where the charge that is tried for all flights is more than any part of the cruise leaves.
TEST(PackFlights, AreFoundWhereNoPartOfTheCruiseKeepsTheChargeThatIsTried) {
    for (const double cruise_s : {777.0, 555.0}) {
        const auto all = fly_packs(read(fmt::format(R"(
mechanical = "fits/mechanical/synthetic-wing.toml"
battery = "fits/battery/synthetic-3s.toml"
reserve_soc_percent = 60
duration_s = {{ cruise = {} }}
[packs]
count = 3
change_s = 60
)",
                                                    cruise_s)));
        EXPECT_TRUE(all.suffice) << describe(all);
        ASSERT_EQ(all.flights.size(), 1U);
        EXPECT_EQ(all.flights.front().cruise_to_s, cruise_s);
    }
}

TEST(PackFlights, ArePlannedEachOnItsOwn) {
    const auto all = fly_packs(
        read_mission(test::source_dir() / "missions/synthetic/several-packs.toml", {.allow_unplanned = true}));
    ASSERT_TRUE(all.suffice) << describe(all);
    double utility = 0.0, time_s = 0.0;
    for (const auto& flight : all.flights) {
        const auto& summary = flight.flown.simulation.summary;
        EXPECT_TRUE(summary.keeps_reserve);
        const auto plan = plan_mission(std::get<PlanningProblem>(flight.mission));
        EXPECT_EQ(plan.mission.schedule, flight.flown.schedule);
        utility += *summary.utility * summary.duration_s;
        time_s += summary.duration_s;
    }
    EXPECT_NEAR(*all.total.utility, utility / time_s, 1e-9);
    EXPECT_NEAR(all.total.duration_s - all.on_ground_s, time_s, 1e-6);
}

/// The share of new flights of each pack, drawn with a seed of their own, that keeps the reserve.
std::vector<double> kept_by_new_flights(const PackFlights& all, std::size_t flights) {
    std::vector<double> kept;
    for (const auto& flight : all.flights) {
        const PreparedMission flown{setup_of(flight.mission), flight.flown.schedule, std::nullopt, {}};
        kept.push_back(1.0 - sample_flights(flown, {}, {flights, 4711 + flight.pack}).probability_below_reserve);
    }
    return kept;
}

/// 4000 flights: 0.02 are almost six standard errors.
TEST(PackFlights, KeepTheReserveWithTheProbabilityWhereTheyGoAsFarAsTheyCan) {
    const auto mission = read("duration_s = { cruise = 6000 }\n" + wing + "[packs]\ncount = 2\nchange_s = 60\n");
    const auto all = fly_packs(mission, {}, 0.95);
    EXPECT_FALSE(all.suffice);
    ASSERT_EQ(all.flights.size(), 2U);
    for (const double share : kept_by_new_flights(all, 4000)) EXPECT_NEAR(share, 0.95, 0.02);
    const auto as_stated = fly_packs(mission);
    for (const double share : kept_by_new_flights(as_stated, 4000)) EXPECT_NEAR(share, 0.5, 0.1);
    EXPECT_LT(all.flights.front().cruise_to_s, as_stated.flights.front().cruise_to_s);
    EXPECT_NEAR(all.flights.front().largest_to_s, all.flights.front().cruise_to_s, 1.0);
}

TEST(PackFlights, KeepTheReserveWithTheProbabilityAsPlanned) {
    const auto mission =
        read_mission(test::source_dir() / "missions/synthetic/several-packs.toml", {.allow_unplanned = true});
    const auto all = fly_packs(mission, {}, 0.95);
    ASSERT_TRUE(all.suffice) << describe(all);
    for (const double share : kept_by_new_flights(all, 2000)) EXPECT_NEAR(share, 0.95, 0.02);
}

/// Charge that is left over is shared: no pack keeps its reserve less often.
TEST(PackFlights, KeepTheReserveMoreOftenWithChargeToSpare) {
    const auto all =
        fly_packs(read("duration_s = { cruise = 3000 }\n" + wing + "[packs]\ncount = 9\nchange_s = 60\n"), {}, 0.95);
    ASSERT_TRUE(all.suffice) << describe(all);
    for (const double share : kept_by_new_flights(all, 2000)) EXPECT_GE(share, 0.93);
}

TEST(PackFlights, AreNotTakenForOneFlight) {
    const auto mission = read(wing + "[packs]\ncount = 3\nchange_s = 60\n");
    EXPECT_NE(rejected([&] { simulate(std::get<Mission>(mission)); }).find("the mission has [packs]"),
              std::string::npos);
}

TEST(PackFlights, HaveAHomeInTheCoordinatesOfThePath) {
    const auto refused = [](const std::string& home, const std::string& leg) {
        return rejected([&] {
            read(wing + "[packs]\ncount = 2\nchange_s = 0\nhome = " + home +
                 "\n[path]\nairspeed_m_per_s = 13\n[[path.leg]]\n" + leg);
        });
    };
    const std::string place = "latitude_deg = 43.4, longitude_deg = 1.2";
    const std::string there =
        "latitude_deg = 43.41\nlongitude_deg = 1.2\n[[path.leg]]\nlatitude_deg = 43.42\nlongitude_deg = 1.2\n";
    EXPECT_EQ(refused("{ " + place + " }", there), "");
    EXPECT_NE(refused("{ " + place + " }", "length_m = 900\ncourse_deg = 0\n").find("home has a latitude"),
              std::string::npos);
    EXPECT_NE(refused("{ " + place + ", up_m = 3 }", "length_m = 900\ncourse_deg = 0\n").find("up_m"),
              std::string::npos);
    EXPECT_NE(refused("{}", "length_m = 900\ncourse_deg = 0\n").find("home is no place"), std::string::npos);
    EXPECT_NE(refused("{ east_m = 1, north_m = 2 }", there).find("home: is in metres"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
