#include "mission/load_segments.h"

#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

Mission mechanical_only() {
    return read_mission(test::source_dir() / "missions" / "paper" / "mechanical-only.toml");
}

/// The integral of the demand's mechanical power by Simpson's rule, to compare with the closed form.
double integral_j(const Demand& demand) {
    const int n = 20000;
    const double h = (demand.to_s - demand.from_s) / n;
    double sum = mechanical_w(demand, demand.from_s) + mechanical_w(demand, demand.to_s);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * mechanical_w(demand, demand.from_s + i * h);
    return sum * h / 3.0;
}

TEST(Demand, EnergyOfAPhaseIsTheIntegralOfItsSeries) {
    const auto demands = demands_of(mechanical_only());
    ASSERT_EQ(demands.size(), 3U);
    const double published_j[] = {803.9, 16385.9, 1686.2};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(mechanical_energy_j(demands[i], demands[i].to_s), integral_j(demands[i]), 1e-7);
        EXPECT_NEAR(mechanical_energy_j(demands[i], demands[i].to_s), published_j[i], 1.0);
    }
}

TEST(Demand, FollowsWithoutGaps) {
    const auto demands = demands_of(read_mission(test::source_dir() / "missions" / "paper" / "phased.toml"));
    ASSERT_EQ(demands.size(), 5U);
    EXPECT_EQ(demands.front().from_s, 0.0);
    for (std::size_t i = 1; i < demands.size(); ++i) EXPECT_EQ(demands[i].from_s, demands[i - 1].to_s);
    EXPECT_EQ(demands.back().to_s, 688.0);
    EXPECT_EQ(demands[2].from_s, 28.0 + 240.0);
    EXPECT_EQ(demands[2].to_s, 28.0 + 360.0);
}

TEST(Demand, AddsComputingToMechanicalPower) {
    const auto demands =
        demands_of(read_mission(test::source_dir() / "missions" / "paper" / "adaptive.toml"));
    const auto& most = demands[2];
    EXPECT_EQ(power_w(most, 300.0), mechanical_w(most, 300.0) + most.compute_w);
    EXPECT_NEAR(most.compute_w, 40.24, 0.005);
    EXPECT_DOUBLE_EQ(compute_energy_j(most, most.to_s), most.compute_w * 120.0);
}

TEST(Demand, SplittingAPhaseChangesNoEnergy) {
    auto mission = mechanical_only();
    const double whole_j = mechanical_energy_j(demands_of(mission)[1], 628.0);
    mission.schedule = {{flight::Phase::cruise, 0.0, 123.4, {}}, {flight::Phase::cruise, 123.4, 600.0, {}}};
    const auto parts = demands_of(mission);
    EXPECT_NEAR(mechanical_energy_j(parts[0], parts[0].to_s) + mechanical_energy_j(parts[1], parts[1].to_s),
                whole_j, 1e-9);
}

TEST(Demand, ClocksAPhaseFlownLonger) {
    auto mission = mechanical_only();
    const auto& cruise = mission.mechanical->phases[flight::Phase::cruise].fourier;
    const auto as_fitted = demands_of(mission)[1];
    mission.duration_s[flight::Phase::cruise] = 900.0;
    mission.schedule[1].to_s = 900.0;
    const auto stretched = demands_of(mission)[1];
    mission.phase_clock = mechanical::PhaseClock::absolute;
    const auto absolute = demands_of(mission)[1];
    for (const double t : {0.0, 100.0, 450.0, 900.0}) {
        EXPECT_NEAR(mechanical_w(stretched, 28.0 + t), mechanical_w(as_fitted, 28.0 + t / 1.5), 1e-12);
        EXPECT_NEAR(mechanical_w(absolute, 28.0 + t), power_w(cruise, t), 1e-12);
    }
    EXPECT_NEAR(mechanical_energy_j(stretched, 928.0), 1.5 * mechanical_energy_j(as_fitted, 628.0), 1e-8);
}

}  // namespace
}  // namespace flightwatt::mission
