#include "mission/simulation.h"

#include "helpers/paper_missions.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::paper_mission;

/// Computing at `power` alone for an hour, with a battery of `battery_wh` that has no resistance.
Mission constant(double power, double battery_wh) {
    Mission mission;
    mission.setup.name = "constant";
    mission.setup.duration_s[flight::Phase::cruise] = 3600.0;
    mission.setup.battery = {"", 10.0, 0.0, battery_wh / 10.0};
    mission.setup.compute.components.push_back(
        {"load", compute::make_power_profile("load.csv", {}, {{{}, power, {}}})});
    mission.schedule = {{flight::Phase::cruise, 0.0, 3600.0, {{0, {}}}}};
    return mission;
}

/// Constant mechanical power in the cruise alone.
Mission flight(double power, double duration_s, const battery::Battery& battery) {
    Mission mission;
    mission.setup.name = "flight";
    mission.setup.mechanical.emplace();
    mission.setup.mechanical->phases[flight::Phase::cruise] = {{1.0, power, {}, {}}, duration_s, {}, {}, 0, 0};
    mission.setup.duration_s[flight::Phase::cruise] = duration_s;
    mission.setup.battery = battery;
    mission.schedule = {{flight::Phase::cruise, 0.0, duration_s, {}}};
    return mission;
}

TEST(Simulation, MeetsTheClosedFormOfConstantPower) {
    const auto [curve, summary] = simulate(constant(25.0, 100.0));
    EXPECT_NEAR(*summary.final_soc_percent, 75.0, 1e-9);
    EXPECT_DOUBLE_EQ(summary.energy_wh, 25.0);
    EXPECT_DOUBLE_EQ(summary.compute_energy_wh, 25.0);
    EXPECT_EQ(summary.mechanical_energy_wh, 0.0);
    EXPECT_DOUBLE_EQ(summary.delivered_energy_wh, 25.0);
    EXPECT_TRUE(summary.feasible);
    for (const auto& row : curve.rows) EXPECT_NEAR(row.soc_percent, 100.0 - row.time_s / 144.0, 1e-9);
}

TEST(Simulation, MeetsTheClosedFormWithResistance) {
    const battery::Battery pack{"", 11.1, 0.08, 2.0};
    const auto summary = simulate(flight(150.0, 200.0, pack)).summary;
    EXPECT_NEAR(*summary.final_soc_percent, 100.0 - 100.0 * internal_current_a(pack, 150.0) * 200.0 / 7200.0, 1e-9);
}

TEST(Simulation, HasARowAtEveryStepAndTwoAtEveryJump) {
    const auto rows = simulate(paper_mission("phased"), {60.0}).curve.rows;
    std::vector<double> times;
    times.reserve(rows.size());
    for (const auto& row : rows) times.push_back(row.time_s);
    EXPECT_EQ(times, (std::vector<double>{0,   28,  28,  60,  120, 180, 240, 268, 268, 300, 360,
                                          388, 388, 420, 480, 540, 600, 628, 628, 660, 688}));
    EXPECT_EQ(rows[1].phase, flight::Phase::takeoff);
    EXPECT_EQ(rows[2].phase, flight::Phase::cruise);
    EXPECT_EQ(rows[1].soc_percent, rows[2].soc_percent);
    EXPECT_NE(rows[7].compute_w, rows[8].compute_w);
    for (const auto& row : rows) {
        EXPECT_EQ(row.power_w, row.mechanical_w + row.compute_w);
        EXPECT_EQ(row.current_a, internal_current_a(paper_mission("phased").setup.battery, row.power_w));
    }
}

TEST(Simulation, HasOneRowWhereNothingJumps) {
    auto mission = constant(25.0, 100.0);
    mission.schedule = {{flight::Phase::cruise, 0.0, 1200.0, {{0, {}}}},
                        {flight::Phase::cruise, 1200.0, 3600.0, {{0, {}}}}};
    const auto rows = simulate(mission, {1200.0}).curve.rows;
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows[1].time_s, 1200.0);
}

TEST(Simulation, RowsIntegrateToTheSummary) {
    const auto [curve, summary] = simulate(paper_mission("phased"), {0.01, 0.01});
    double energy_j = 0.0;
    double charge_as = 0.0;
    for (std::size_t i = 1; i < curve.rows.size(); ++i) {
        const auto& a = curve.rows[i - 1];
        const auto& b = curve.rows[i];
        EXPECT_LE(a.time_s, b.time_s);
        energy_j += (a.power_w + b.power_w) / 2.0 * (b.time_s - a.time_s);
        charge_as += (a.current_a + b.current_a) / 2.0 * (b.time_s - a.time_s);
    }
    EXPECT_NEAR(energy_j / 3600.0, summary.energy_wh, 1e-8);
    EXPECT_NEAR(100.0 - charge_as / (3600.0 * 3.2) * 100.0, *summary.final_soc_percent, 1e-6);
    EXPECT_EQ(summary.energy_wh, summary.mechanical_energy_wh + summary.compute_energy_wh);
    EXPECT_EQ(curve.rows.back().soc_percent, *summary.final_soc_percent);
}

TEST(Simulation, DoesNotDependOnTheSteps) {
    auto mission = paper_mission("phased");
    mission.setup.battery.resistance_ohm = 0.005;
    mission.setup.battery.voltage_v = 3.6;
    const auto reference = simulate(mission, {1.0, 0.01}).summary;
    for (const auto& steps : {SimulationOptions{}, {0.03}, {7.77}, {1e6}, {1.0, 0.1}}) {
        const auto summary = simulate(mission, steps).summary;
        EXPECT_NEAR(*summary.final_soc_percent, *reference.final_soc_percent, 1e-6) << steps.output_s;
        EXPECT_EQ(summary.energy_wh, reference.energy_wh);
    }
    const auto without_curve = simulate(mission, {.with_curve = false});
    EXPECT_TRUE(without_curve.curve.rows.empty());
    EXPECT_EQ(without_curve.summary.final_soc_percent, simulate(mission).summary.final_soc_percent);
    mission = paper_mission("invariant-32fps-448bit");
    const double empty_s = *simulate(mission, {1.0, 0.01}).summary.depleted_at_s;
    for (const auto& steps : {SimulationOptions{}, {7.77}, {1e6}, {1.0, 0.1}}) {
        EXPECT_NEAR(*simulate(mission, steps).summary.depleted_at_s, empty_s, 1e-6);
    }
}

TEST(Simulation, StopsAtEmpty) {
    // 20 Wh at 25 W last 48 minutes of the hour.
    const auto [curve, summary] = simulate(constant(25.0, 20.0));
    EXPECT_EQ(summary.final_soc_percent, 0.0);
    ASSERT_TRUE(summary.depleted_at_s);
    EXPECT_NEAR(*summary.depleted_at_s, 2880.0, 1e-8);
    EXPECT_FALSE(summary.feasible);
    EXPECT_DOUBLE_EQ(summary.energy_wh, 25.0);  // what the mission demands
    EXPECT_NEAR(summary.delivered_energy_wh, 20.0, 1e-9);
    for (const auto& row : curve.rows) {
        EXPECT_GE(row.soc_percent, 0.0);
        EXPECT_EQ(row.power_w, 25.0);
        if (row.time_s > *summary.depleted_at_s) {
            EXPECT_EQ(row.soc_percent, 0.0);
            EXPECT_EQ(row.current_a, 0.0);
        } else if (row.time_s < *summary.depleted_at_s) {
            EXPECT_EQ(row.current_a, 2.5);
        }
    }
    const auto at_empty = std::count_if(
        curve.rows.begin(), curve.rows.end(),
        [&, t = *summary.depleted_at_s](const auto& row) { return row.time_s == t && row.soc_percent == 0.0; });
    EXPECT_EQ(at_empty, 2);  // with its current, and without
    EXPECT_EQ(curve.rows.back().time_s, 3600.0);
}

TEST(Simulation, FindsDepletionBetweenRows) {
    const double power = 31.7;
    const auto summary = simulate(constant(power, 20.0), {600.0}).summary;
    ASSERT_TRUE(summary.depleted_at_s);
    EXPECT_NEAR(*summary.depleted_at_s, 20.0 / power * 3600.0, 1e-8);
}

TEST(Simulation, IsFeasibleIfEmptyExactlyAtTheEnd) {
    const auto summary = simulate(constant(25.0, 25.0)).summary;
    EXPECT_TRUE(summary.feasible);
    EXPECT_FALSE(summary.depleted_at_s);
    EXPECT_NEAR(*summary.final_soc_percent, 0.0, 1e-9);
    const auto short_of = simulate(constant(25.0, 24.999)).summary;
    EXPECT_FALSE(short_of.feasible);
    EXPECT_TRUE(short_of.depleted_at_s);
}

TEST(Simulation, BeginsWithTheInitialCharge) {
    auto mission = constant(25.0, 100.0);
    mission.setup.initial_soc_percent = 40.0;
    const auto [curve, summary] = simulate(mission);
    EXPECT_EQ(curve.rows.front().soc_percent, 40.0);
    EXPECT_NEAR(*summary.final_soc_percent, 15.0, 1e-9);
}

TEST(Simulation, ChargesOnNegativePowerAndStaysBelowFull) {
    const battery::Battery pack{"", 10.0, 0.01, 1.0};
    auto mission = flight(-10.0, 360.0, pack);
    mission.setup.may_charge = true;
    EXPECT_EQ(*simulate(mission).summary.final_soc_percent, 100.0);
    mission.setup.initial_soc_percent = 50.0;
    const auto summary = simulate(mission).summary;
    EXPECT_NEAR(*summary.final_soc_percent, 50.0 - 10.0 * internal_current_a(pack, -10.0), 1e-9);
    EXPECT_GT(*summary.final_soc_percent, 59.9);
    EXPECT_DOUBLE_EQ(summary.energy_wh, -1.0);
}

TEST(Simulation, ReportsPowerThatTheBatteryCannotDeliver) {
    auto mission = paper_mission("phased");
    mission.setup.battery = {"", 11.1, 0.5, 3.2};  // at most 61.6 W; the middle of the cruise needs 68
    const auto [curve, summary] = simulate(mission);
    ASSERT_TRUE(summary.undeliverable);
    EXPECT_EQ(summary.undeliverable->time_s, 268.0);
    EXPECT_NEAR(summary.undeliverable->power_w, 68.3, 0.01);
    EXPECT_DOUBLE_EQ(summary.undeliverable->limit_w, 11.1 * 11.1 / 2.0);
    EXPECT_FALSE(summary.final_soc_percent);
    EXPECT_FALSE(summary.feasible);
    EXPECT_EQ(curve.rows.back().time_s, 268.0);
    EXPECT_LT(summary.delivered_energy_wh, summary.energy_wh);
    for (const auto& row : curve.rows) EXPECT_TRUE(std::isfinite(row.current_a));
    EXPECT_EQ(describe(summary),
              "phased: the battery cannot deliver 68.2975 W after 4 min 28 s: its limit U^2 / (4 R) is 61.605 W");
}

/// 12 V at full, 10 V at empty, 0.1 ohm; 0.06 ohm with 30 s.
battery::Battery thevenin_pack(double capacity_ah) {
    battery::Battery pack{"", 0.0, 0.1, capacity_ah};
    pack.thevenin = battery::TheveninCircuit{{{0.0, 100.0}, {10.0, 12.0}}, 0.06, 30.0};
    return pack;
}

TEST(Simulation, ShowsTheTerminalVoltage) {
    const auto pack = thevenin_pack(3.0);
    const auto [curve, summary] = simulate(flight(40.0, 600.0, pack));
    EXPECT_TRUE(summary.feasible);
    for (std::size_t i = 1; i < curve.rows.size(); ++i) {
        const auto& row = curve.rows[i];
        EXPECT_NEAR(row.terminal_voltage_v * row.current_a, row.power_w, 1e-9);  // what the load gets
        EXPECT_LT(row.terminal_voltage_v, curve.rows[i - 1].terminal_voltage_v);
    }
    for (const auto& row : simulate(flight(150.0, 60.0, {"", 11.1, 0.08, 2.0})).curve.rows) {
        EXPECT_EQ(row.terminal_voltage_v, 11.1 - 0.08 * row.current_a);
    }
}

TEST(Simulation, FliesTheExampleOnTheSyntheticPack) {
    auto mission =
        std::get<Mission>(read_mission(test::source_dir() / "missions" / "synthetic" / "thevenin-pack.toml"));
    ASSERT_TRUE(mission.setup.battery.thevenin);
    EXPECT_NEAR(mission.setup.battery.resistance_ohm, 0.06, 0.001);  // what the logs were made with
    const auto summary = simulate(mission, {60.0}).summary;
    EXPECT_TRUE(summary.keeps_reserve);
    // The charge is the energy by the mean voltage, which is between those at both ends.
    const double drawn_ah = (100.0 - *summary.final_soc_percent) / 100.0 * mission.setup.battery.capacity_ah;
    EXPECT_GT(drawn_ah, summary.energy_wh / 12.24);
    EXPECT_LT(drawn_ah, summary.energy_wh / 11.07);
    mission.setup.cutoff_voltage_v = 11.5;
    EXPECT_TRUE(simulate(mission).summary.cut_off_at_s);
}

TEST(Simulation, EndsAtCutOff) {
    auto mission = flight(40.0, 3000.0, thevenin_pack(3.0));
    mission.setup.cutoff_voltage_v = 10.5;
    const auto [curve, summary] = simulate(mission);
    ASSERT_TRUE(summary.cut_off_at_s);
    EXPECT_FALSE(summary.depleted_at_s);
    EXPECT_FALSE(summary.feasible);
    EXPECT_FALSE(summary.keeps_reserve);
    EXPECT_GT(*summary.final_soc_percent, 20.0);
    EXPECT_NEAR(summary.delivered_energy_wh, 40.0 * *summary.cut_off_at_s / 3600.0, 1e-9);
    std::size_t loaded = 0;
    for (const auto& row : curve.rows) {
        if (row.current_a > 0.0) {
            ++loaded;
            EXPECT_GE(row.terminal_voltage_v, 10.5 - 1e-9);
        } else {
            EXPECT_EQ(row.soc_percent, *summary.final_soc_percent);
        }
    }
    EXPECT_EQ(loaded, static_cast<std::size_t>(*summary.cut_off_at_s) + 2);
    // Without a load the voltage recovers to that of the open circuit.
    EXPECT_NEAR(curve.rows.back().terminal_voltage_v,
                open_circuit_voltage_v(mission.setup.battery, *summary.final_soc_percent), 1e-3);
    EXPECT_EQ(describe(summary).substr(0, 21), "flight: cut off after");
    for (const auto& steps : {SimulationOptions{}, {7.77}, {1e6}, {1.0, 0.01}}) {
        EXPECT_NEAR(*simulate(mission, steps).summary.cut_off_at_s, *summary.cut_off_at_s, 1e-6);
    }
}

TEST(Simulation, KeepsTheReserveOrSaysThatItDoesNot) {
    auto mission = constant(25.0, 100.0);
    mission.setup.reserve_soc_percent = 75.001;
    const auto missed = simulate(mission).summary;
    EXPECT_TRUE(missed.feasible);  // the battery lasts
    EXPECT_FALSE(missed.keeps_reserve);
    EXPECT_EQ(missed.reserve_soc_percent, 75.001);
    EXPECT_EQ(describe(missed).substr(0, 69), "constant: 75.00 % left after 1 h, less than the reserve of 75.001 %; ");
    mission.setup.reserve_soc_percent = 74.999;
    EXPECT_TRUE(simulate(mission).summary.keeps_reserve);
}

TEST(Simulation, DescribesItsOutcome) {
    EXPECT_EQ(describe(simulate(constant(25.0, 100.0)).summary),
              "constant: 75.00 % left after 1 h; 25.000 Wh, 0.000 mechanical and 25.000 computing");
    EXPECT_EQ(describe(simulate(constant(25.0, 20.0)).summary),
              "constant: empty after 48 min of 1 h; 25.000 Wh, 0.000 mechanical and 25.000 computing");
}

/// `constant` on a pack of 20 Ah whose flights indicate 10 Ah, 8 to 12.
Mission on_doubtful_pack(double power) {
    auto mission = constant(power, 200.0);
    mission.setup.battery.flight_estimate =
        std::make_shared<battery::FlightEstimate>(battery::FlightEstimate{10.0, {8.0, 12.0}});
    return mission;
}

TEST(Simulation, LandsWithTheCapacityThatTheFlightsIndicate) {
    auto mission = on_doubtful_pack(25.0);
    mission.setup.reserve_soc_percent = 80.0;
    const auto landing = landing_by_flights(mission.setup, mission.schedule);
    ASSERT_TRUE(landing);
    EXPECT_EQ(landing->capacity_ah, 10.0);
    EXPECT_NEAR(landing->final_soc_percent.value(), 75.0, 1e-9);
    EXPECT_FALSE(landing->fails_at_s);
    EXPECT_FALSE(landing->keeps_reserve) << "as modelled, with 87.5 %, it does";
    EXPECT_EQ(describe(*landing), "75.00 % with the 10 Ah that the flights indicate");
    mission.setup.battery.capacity_ah = 12.0;
    EXPECT_FALSE(landing_by_flights(mission.setup, mission.schedule)) << "the capacity is one that they allow";
    mission.setup.battery.flight_estimate.reset();
    EXPECT_FALSE(landing_by_flights(mission.setup, mission.schedule)) << "a pack of no flights";
}

TEST(Simulation, FailsWithTheCapacityThatTheFlightsIndicate) {
    const auto mission = on_doubtful_pack(125.0);
    EXPECT_TRUE(simulate(mission).summary.feasible);
    const auto landing = landing_by_flights(mission.setup, mission.schedule).value();
    EXPECT_NEAR(landing.fails_at_s.value(), 2880.0, 1e-3);
    EXPECT_EQ(describe(landing), "the battery fails after 48 min with the 10 Ah that the flights indicate");
    auto summary = simulate(mission).summary;
    summary.by_flights = landing;
    EXPECT_NE(describe(summary).find("37.50 % left after 1 h (the battery fails after 48 min with"), std::string::npos);
}

TEST(Simulation, WritesCsv) {
    EXPECT_EQ(to_csv(simulate(constant(25.0, 100.0), {1800.0}).curve),
              "time_s,phase,mechanical_w,compute_w,power_w,current_a,soc_percent,terminal_voltage_v\n"
              "0,cruise,0,25,25,2.5,100,10\n1800,cruise,0,25,25,2.5,87.5,10\n3600,cruise,0,25,25,2.5,75,10\n");
}

TEST(Simulation, RefusesStepsThatMakeNoSense) {
    const auto mission = constant(25.0, 100.0);
    for (const double step : {0.0, -1.0, std::nan(""), 1e-6, static_cast<double>(INFINITY)}) {
        EXPECT_THROW(simulate(mission, {step}), UsageError) << step;
    }
    EXPECT_THROW(simulate(Mission{}), std::invalid_argument);
}

}  // namespace
}  // namespace flightwatt::mission
