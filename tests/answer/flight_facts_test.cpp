#include "answer/flight_facts.h"

#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

TEST(FlightFacts, AreOfTheCruiseOfAFlight) {
    const auto loaded =
        flight::load_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data", flight::LoadOptions{});
    const auto facts = flight_facts(loaded);
    ASSERT_EQ(facts.size(), 1U);
    EXPECT_EQ(facts.front().flight, "opterra_synthetic_01");
    EXPECT_GT(facts.front().cruise_s, 300.0);
    EXPECT_NEAR(facts.front().ground_speed_m_per_s.value(), 13.0, 2.0);
    EXPECT_NEAR(facts.front().mean_voltage_v.value(), 11.5, 1.0);
    EXPECT_FALSE(facts.front().stated_capacity_ah) << "Paparazzi's logs state none";
}

/// A flight from 100 to 200 s that flies 500 m away and back, after a way of 3 km to where it starts.
flight::LoadedFlight flown_places() {
    flight::LoadedFlight loaded;
    for (int second = 0; second <= 300; ++second) {
        const double time_s = second;
        loaded.data.latitude_deg.time_s.push_back(time_s);
        loaded.data.longitude_deg.time_s.push_back(time_s);
        const double way_m =
            std::max(0.0, 30.0 * (100.0 - time_s)) + std::max(0.0, 500.0 - 10.0 * std::abs(time_s - 150.0));
        loaded.data.latitude_deg.value.push_back(47.0 + way_m / 111195.0);
        loaded.data.longitude_deg.value.push_back(8.0);
    }
    flight::PhaseSpan cruise;
    cruise.phase = flight::Phase::cruise;
    cruise.start.time_s = 100.0;
    cruise.end.time_s = 200.0;
    flight::Sortie sortie;
    sortie.phases.push_back(cruise);
    loaded.phases.sorties.push_back(sortie);
    return loaded;
}

TEST(FlightFacts, CountTheDistanceFromWhereTheFlightBegan) {
    EXPECT_NEAR(flight_facts(flown_places()).front().farthest_m.value(), 500.0, 1.0);
}

TEST(FlightFacts, HaveTheTimeOfAVtolOnItsWing) {
    auto loaded = flown_places();
    EXPECT_FALSE(flight_facts(loaded).front().wing_s);
    loaded.data.vtol_state.time_s = {0.0, 120.0};
    loaded.data.vtol_state.value = {static_cast<double>(flight::VtolState::hover),
                                    static_cast<double>(flight::VtolState::wing)};
    EXPECT_EQ(flight_facts(loaded).front().wing_s, std::optional(80.0));
    EXPECT_DOUBLE_EQ(wing_share(flight_facts(loaded)), 0.8);
    EXPECT_EQ(wing_share({}), 1.0);
    const FlightFacts hover{.flight = "h", .cruise_s = 300.0, .wing_s = 0.0};
    const FlightFacts wing{.flight = "w", .cruise_s = 600.0, .wing_s = 600.0};
    EXPECT_EQ(wing_share(fitted_facts({hover, wing})), 1.0) << "the fit leaves the hover out";
    EXPECT_EQ(wing_share(fitted_facts({hover, hover})), 0.0);
    EXPECT_DOUBLE_EQ(wing_share(fitted_facts({hover, wing}, {"h"})), 600.0 / 900.0);
}

TEST(MeanGroundSpeed, WeighsCruisesByTheirDuration) {
    EXPECT_NEAR(mean_ground_speed_m_per_s({{"a", 100.0, 10.0}, {"b", 300.0, 14.0}, {"c", 900.0}}).value(), 13.0, 1e-12);
    EXPECT_FALSE(mean_ground_speed_m_per_s({{"a", 100.0}}));
}

}  // namespace
}  // namespace flightwatt::answer
