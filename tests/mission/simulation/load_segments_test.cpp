#include "mission/simulation/load_segments.h"

#include "helpers/paper_missions.h"
#include "mission/simulation.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

Mission mechanical_only() { return test::paper_mission("mechanical-only"); }

std::vector<LoadSegment> load_of(const Mission& mission) { return load_segments(mission, mission.schedule); }

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
    const auto& cruise = mission.mechanical->phases[flight::Phase::cruise].fourier;
    const auto as_fitted = load_of(mission)[1];
    mission.duration_s[flight::Phase::cruise] = 900.0;
    mission.schedule[1].end_s = 900.0;
    const auto stretched = load_of(mission)[1];
    mission.phase_clock = mechanical::PhaseTimeScaling::absolute;
    const auto absolute = load_of(mission)[1];
    for (const double t : {0.0, 100.0, 450.0, 900.0}) {
        EXPECT_NEAR(mechanical_w(stretched, 28.0 + t), mechanical_w(as_fitted, 28.0 + t / 1.5), 1e-12);
        EXPECT_NEAR(mechanical_w(absolute, 28.0 + t), power_w(cruise, t), 1e-12);
    }
    EXPECT_NEAR(mechanical_energy_j(stretched, 928.0), 1.5 * mechanical_energy_j(as_fitted, 628.0), 1e-8);
}

TEST(SegmentDischarge, AgreesWithTheSimulation) {
    for (const double resistance_ohm : {0.0, 0.01}) {
        auto mission = test::paper_mission("phased");
        mission.battery.resistance_ohm = resistance_ohm;
        mission.battery.capacity_ah = 4.0;
        battery::Discharge charge;
        charge.soc_percent = 100.0;
        for (const auto& segment : load_segments(mission, mission.schedule))
            charge = advance_segment(mission.battery, mission.cutoff_voltage_v, segment, charge);
        EXPECT_NEAR(charge.soc_percent, *simulate(mission).summary.final_soc_percent, 1e-6);
    }
}

}  // namespace
}  // namespace flightwatt::mission
