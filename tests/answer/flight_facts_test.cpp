#include "answer/flight_facts.h"

#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"

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

TEST(MeanGroundSpeed, WeighsCruisesByTheirDuration) {
    EXPECT_NEAR(mean_ground_speed_m_per_s({{"a", 100.0, 10.0}, {"b", 300.0, 14.0}, {"c", 900.0}}).value(), 13.0, 1e-12);
    EXPECT_FALSE(mean_ground_speed_m_per_s({{"a", 100.0}}));
}

}  // namespace
}  // namespace flightwatt::answer
