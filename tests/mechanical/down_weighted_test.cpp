#include "mechanical/down_weighted.h"

#include "helpers/made_up_flights.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// Two cruises of 0.1 W noise; every 25th sample of the second, from the sixth on, is 8 W too high.
std::vector<PhaseSamples> with_outliers() {
    auto flights = test::record_flights(flight::Phase::cruise, 2, 0.1, 1);
    flights[1].start_s = 1000.0;
    for (std::size_t j = 5; j < flights[1].tau.size(); j += 25) flights[1].power_w[j] += 8.0;
    return flights;
}

TEST(DownWeightedSamples, AreTheOutliersFirst) {
    const auto flights = with_outliers();
    const auto fit = fit_phase(flight::Phase::cruise, flights, {.loss = Loss::huber});
    const auto found = down_weighted_samples(flights, fit);
    const std::size_t outliers = (flights[1].tau.size() - 5 + 24) / 25;
    ASSERT_GE(found.size(), outliers);
    EXPECT_LE(found.size(), outliers + 40) << "of normal noise 0.7 % count less than half";
    for (std::size_t i = 0; i < outliers; ++i) {
        EXPECT_EQ(found[i].flight, "flight2");
        EXPECT_NEAR(found[i].residual_w, 8.0, 0.5);
        EXPECT_LT(found[i].weight, 0.05);
        EXPECT_GT(found[i].log_time_s, 1000.0);
    }
}

TEST(DownWeightedSamples, CountLessThanHalfAndRise) {
    const auto flights = with_outliers();
    const auto found =
        down_weighted_samples(flights, fit_phase(flight::Phase::cruise, flights, {.loss = Loss::huber}));
    ASSERT_FALSE(found.empty());
    EXPECT_LT(found.back().weight, 0.5);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(),
                               [](const auto& a, const auto& b) { return a.weight < b.weight; }));
}

TEST(DownWeightedSamples, AreNoneOfAPlainFit) {
    const auto flights = with_outliers();
    EXPECT_TRUE(down_weighted_samples(flights, fit_phase(flight::Phase::cruise, flights)).empty());
}

}  // namespace
}  // namespace flightwatt::mechanical
