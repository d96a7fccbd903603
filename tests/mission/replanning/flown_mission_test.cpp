#include "mission/replanning/flown_mission.h"

#include "helpers/replayed_flights.h"
#include "helpers/steady_mission.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(PowerPieces, HaveTheEnergyBetweenTheirSamples) {
    mechanical::PhasePower measured;
    measured.time_s = {0.0, 2.0, 5.0, 27.0, 27.4, 27.8, 28.6, 29.0};  // with a gap of 22 s, and faster at the end
    measured.power_w = {10.0, 20.0, 30.0, 20.0, 10.0, 10.0, 20.0, 40.0};
    const auto pieces = measured_power_profile(measured);
    EXPECT_EQ(pieces.time_s, (std::vector<double>{0.0, 2.0, 5.0, 27.0, 28.6, 29.0})) << "of 1 s or more, but the last";
    EXPECT_EQ(pieces.energy_j[1], 2.0 * 15.0);
    EXPECT_EQ(pieces.energy_j[2] - pieces.energy_j[1], 3.0 * 25.0);
    EXPECT_EQ(pieces.energy_j[3] - pieces.energy_j[2], 22.0 * 25.0) << "a straight line over the gap";
    EXPECT_NEAR(pieces.energy_j[4] - pieces.energy_j[3], 6.0 + 4.0 + 12.0, 1e-9);
    EXPECT_NEAR(energy_until_j(pieces, 29.0), 30.0 + 75.0 + 550.0 + 22.0 + 12.0, 1e-9);
    EXPECT_NEAR(energy_until_j(pieces, 5.0), 105.0, 1e-9);
}

TEST(PowerPieces, GiveNothingBack) {
    const auto pieces = measured_power_profile({{0.0, 10.0, 20.0}, {-4.0, -4.0, 24.0}, {}});
    EXPECT_EQ(pieces.energy_j[1], 0.0);
    EXPECT_EQ(energy_until_j(pieces, 20.0), 100.0);
}

TEST(KnownMission, TakesTheModelAndWhatTheMissionStates) {
    auto stated = test::steady_mission().setup;
    auto model = *stated.mechanical;
    model.phases[Phase::cruise].duration_s = 700.0;
    model.phases[Phase::landing].duration_s = 60.0;
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::cruise], 700.0);
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::landing], 0.0) << "it has none";
    stated.duration_is_stated[Phase::cruise] = true;
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::cruise], 1000.0);
}

TEST(FlownMission, HasPowerAndDurationsOfTheFlight) {
    const auto known = test::steady_mission().setup;
    const auto flight = test::flight_with_power("f", {{10.0, 500.0, 10.0}}, [](auto, double) { return 30.0; });
    const auto flown = measured_mission(known, flight);
    EXPECT_EQ(flown.duration_s[Phase::cruise], 500.0);
    EXPECT_EQ(flown.duration_s[Phase::takeoff], 0.0) << "the mission has none";
    EXPECT_FALSE(flown.measured_power[Phase::takeoff]);
    EXPECT_NEAR(energy_until_j(*flown.measured_power[Phase::cruise], 500.0), 15000.0, 1e-6);
}

}  // namespace
}  // namespace flightwatt::mission
