#include "mission/simulation/load_segments.h"

#include "helpers/drawn_mission.h"
#include "helpers/paper_missions.h"
#include "helpers/rejected.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "mission/sampling/flight_draws.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

Mission mechanical_only() { return test::paper_mission("mechanical-only"); }

std::vector<LoadSegment> load_of(const Mission& mission) { return load_segments(mission.setup, mission.schedule); }

/// The integral of the demand's mechanical power by Simpson's rule, to compare with the closed form.
double integral_j(const LoadSegment& segment) {
    const int n = 20000;
    const double h = (segment.end_s - segment.start_s) / n;
    double sum = mechanical_w(segment, segment.start_s) + mechanical_w(segment, segment.end_s);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * mechanical_w(segment, segment.start_s + i * h);
    return sum * h / 3.0;
}

TEST(LoadSegment, EnergyOfAPhaseIsTheIntegralOfItsSeries) {
    const auto segments = load_of(mechanical_only());
    ASSERT_EQ(segments.size(), 3U);
    const double published_j[] = {803.9, 16385.9, 1686.2};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(mechanical_energy_j(segments[i], segments[i].end_s), integral_j(segments[i]), 1e-7);
        EXPECT_NEAR(mechanical_energy_j(segments[i], segments[i].end_s), published_j[i], 1.0);
    }
}

TEST(LoadSegment, FollowsWithoutGaps) {
    const auto segments = load_of(test::paper_mission("phased"));
    ASSERT_EQ(segments.size(), 5U);
    EXPECT_EQ(segments.front().start_s, 0.0);
    for (std::size_t i = 1; i < segments.size(); ++i) EXPECT_EQ(segments[i].start_s, segments[i - 1].end_s);
    EXPECT_EQ(segments.back().end_s, 688.0);
    EXPECT_EQ(segments[2].start_s, 28.0 + 240.0);
    EXPECT_EQ(segments[2].end_s, 28.0 + 360.0);
}

TEST(LoadSegment, AddsComputingToMechanicalPower) {
    const auto segments = load_of(test::paper_mission("adaptive"));
    const auto& most = segments[2];
    EXPECT_EQ(power_w(most, 300.0), mechanical_w(most, 300.0) + most.compute_w);
    EXPECT_NEAR(most.compute_w, 40.24, 0.005);
    EXPECT_DOUBLE_EQ(compute_energy_j(most, most.end_s), most.compute_w * 120.0);
}

TEST(LoadSegment, SplittingAPhaseChangesNoEnergy) {
    auto mission = mechanical_only();
    const double whole_j = mechanical_energy_j(load_of(mission)[1], 628.0);
    mission.schedule = {{flight::Phase::cruise, 0.0, 123.4, {}}, {flight::Phase::cruise, 123.4, 600.0, {}}};
    const auto parts = load_of(mission);
    EXPECT_NEAR(mechanical_energy_j(parts[0], parts[0].end_s) + mechanical_energy_j(parts[1], parts[1].end_s), whole_j,
                1e-9);
}

TEST(LoadSegment, ClocksAPhaseFlownLonger) {
    auto mission = mechanical_only();
    const auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise].fourier;
    const auto as_fitted = load_of(mission)[1];
    mission.setup.duration_s[flight::Phase::cruise] = 900.0;
    mission.schedule[1].end_s = 900.0;
    const auto scaled = load_of(mission)[1];
    mission.setup.phase_clock = mechanical::PhaseTimeScaling::absolute;
    const auto absolute = load_of(mission)[1];
    for (const double t : {0.0, 100.0, 450.0, 900.0}) {
        EXPECT_NEAR(mechanical_w(scaled, 28.0 + t), mechanical_w(as_fitted, 28.0 + t / 1.5), 1e-12);
        EXPECT_NEAR(mechanical_w(absolute, 28.0 + t), power_w(cruise, t), 1e-12);
    }
    EXPECT_NEAR(mechanical_energy_j(scaled, 928.0), 1.5 * mechanical_energy_j(as_fitted, 628.0), 1e-8);
}

/// State of charge after the mission's own schedule, segment by segment.
double advanced_soc(const Mission& mission) {
    battery::Discharge charge{{mission.setup.initial_soc_percent}};
    for (const auto& segment : load_segments(mission.setup, mission.schedule))
        charge = advance_segment(mission.setup.battery, mission.setup.cutoff_voltage_v, segment, charge);
    return charge.soc_percent;
}

/// A schedule of segments that begin and end anywhere.
std::vector<ScheduleSegment> random_schedule(const Mission& mission, std::mt19937& random) {
    const auto known = configurations_of(mission.schedule);
    std::uniform_int_distribution<std::size_t> any(0, known.size() - 1);
    std::vector<ScheduleSegment> schedule;
    for (const auto phase : flight::all_phases) {
        const double duration_s = mission.setup.duration_s[phase];
        std::uniform_real_distribution<double> length_s(0.01, 90.0);
        for (double start_s = 0.0; start_s < duration_s;) {
            const double end_s = std::min(duration_s, start_s + length_s(random));
            schedule.push_back({phase, start_s, end_s, known[any(random)]});
            start_s = end_s;
        }
    }
    return schedule;
}

TEST(SegmentDischarge, AgreesWithRungeKuttaOnThePapersSchedules) {
    for (const auto* name : {"computing-only", "mechanical-only", "invariant-5.8fps-32bit", "invariant-10fps-240bit",
                             "phased", "adaptive"}) {
        const auto mission = test::paper_mission(name);
        EXPECT_NEAR(advanced_soc(mission), *simulate(mission).summary.final_soc_percent, 1e-8) << name;
    }
    EXPECT_EQ(advanced_soc(test::paper_mission("invariant-32fps-448bit")), 0.0) << "empty before the end";
}

TEST(SegmentDischarge, AgreesWithRungeKuttaOnRandomSchedules) {
    std::mt19937 random(3);
    for (const double resistance_ohm : {0.0, 0.002, 0.02, 0.04}) {
        auto mission = test::paper_mission("phased");
        mission.setup.battery = {"", 3.6, resistance_ohm, 6.0};
        for (int i = 0; i < 10; ++i) {
            mission.schedule = random_schedule(mission, random);
            const double soc_percent = advanced_soc(mission);
            EXPECT_GT(soc_percent, 10.0) << "would not be empty";
            EXPECT_NEAR(soc_percent, simulate(mission, {10.0, 0.05}).summary.final_soc_percent.value(), 1e-6)
                << resistance_ohm;
        }
    }
}

TEST(LeastPower, IsThatOfAFineGrid) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 50; ++i) {
        const mechanical::FourierModel curve{0.2 + 0.1 * uniform(random),
                                             1.0,
                                             {uniform(random), uniform(random), uniform(random)},
                                             {uniform(random), uniform(random), uniform(random)}};
        const TimeInterval within{5.0 * (1.0 + uniform(random)), 40.0 + 20.0 * uniform(random)};
        double min_w = 1e9;
        for (int k = 0; k <= 100000; ++k) {
            const double time_s = within.start_s + (within.end_s - within.start_s) * k / 100000.0;
            min_w = std::min(min_w, power_w(curve, time_s));
        }
        const auto least = min_power_w(curve, within, 1e9);
        EXPECT_NEAR(least.power_w, min_w, 1e-6);
        EXPECT_NEAR(power_w(curve, least.time_s), least.power_w, 1e-12);
    }
}

/// The paper's mission with a landing that takes power back.
Mission with_negative_landing() {
    auto mission = test::paper_mission("mechanical-only");
    mission.setup.file = "m.toml";
    mission.setup.mechanical->phases[Phase::landing].fourier = {0.05, -2.0, {1.0}, {0.0}};
    return mission;
}

TEST(Charging, IsRefusedUnlessItIsMeant) {
    auto mission = with_negative_landing();
    const auto text = test::rejected([&] { simulate(mission); });
    EXPECT_EQ(text.substr(0, text.find(';')),
              "m.toml: mechanical-only: 60.0 s into the landing it draws -2.99 W (-2.99 W mechanical, 0 W computing), "
              "which charges the battery in flight");
    EXPECT_THROW(simulate_prepared(prepare_mission(mission)), InputError);
    mission.setup.may_charge = true;
    EXPECT_TRUE(simulate(mission).summary.feasible);
    mission.setup.may_charge = false;
    mission.setup.compute.components.push_back({"camera", compute::make_power_profile("p", {}, {{{}, 5.0, {}}})});
    for (auto& segment : mission.schedule) segment.run = {{0, {}}};
    EXPECT_TRUE(simulate(mission).summary.feasible) << "with what computes, nothing charges";
}

TEST(Charging, IsAskedForByADisturbance) {
    const auto mission = test::paper_mission("mechanical-only");
    Disturbance sun;
    sun.compute_w = -100.0;
    EXPECT_GT(*simulate(mission, {}, {sun}).summary.final_soc_percent, 99.0);
}

TEST(Charging, HappensInNoFlightThatIsDrawn) {
    auto mission = test::paper_mission("mechanical-only");
    for (const auto phase : flight::all_phases) mission.setup.uncertainty.level_sd_percent[phase] = 60.0;
    mission.setup.phase_clock = mechanical::PhaseTimeScaling::absolute;
    const auto spreads = collect_uncertainty(mission.setup);
    double mean_w = 0.0;
    constexpr int flights = 4000;
    for (std::uint64_t i = 0; i < flights; ++i) {
        auto flight = Mission{apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, i)),
                              mission.schedule};
        for (const auto& segment : load_segments(flight.setup, flight.schedule))
            EXPECT_GE(min_power_w(*segment.mechanical, {0.0, segment.end_s - segment.phase_start_s}).power_w, -1e-9);
        const auto& cruise = flight.setup.mechanical->phases[Phase::cruise].fourier;
        mean_w += energy_j(cruise, 600.0) / 600.0 / flights;
    }
    const auto& stated = mission.setup.mechanical->phases[Phase::cruise].fourier;
    const double stated_w = energy_j(stated, 600.0) / 600.0;
    // A normal number that stops at 0: 5 % of the flights are there.
    EXPECT_NEAR(mean_w / stated_w, 1.0 + 0.6 * 0.0212, 0.03);
}

}  // namespace
}  // namespace flightwatt::mission
