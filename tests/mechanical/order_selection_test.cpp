#include "mechanical/order_selection.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"

#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// Cruises whose series has that order, with 0.1 W of noise.
std::vector<PhaseSamples> flights_of_order(std::size_t order, std::size_t count, unsigned seed) {
    const std::vector<double> cos_w{2.0, 1.0, 0.9, 0.8, 0.7};
    const std::vector<double> sin_w{-1.0, 1.5, -0.9, 0.8, 0.6};
    auto phase = test::cruise_of(1.2, {cos_w.begin(), cos_w.begin() + static_cast<std::ptrdiff_t>(order)},
                                 {sin_w.begin(), sin_w.begin() + static_cast<std::ptrdiff_t>(order)});
    std::mt19937 random(seed);
    std::vector<PhaseSamples> flights;
    for (std::size_t i = 0; i < count; ++i) {
        flights.push_back(test::record(phase, {600.0, 2.0, 0.1, 0.1}, random, "flight" + std::to_string(i + 1)));
    }
    return flights;
}

TEST(OrderSelection, FindsTheOrderThatTheFlightsWereMadeOf) {
    for (const std::size_t order : {0U, 1U, 2U, 3U, 5U}) {
        const auto several = select_order(flight::Phase::cruise, flights_of_order(order, 4, 1), {}, {});
        EXPECT_EQ(several.order, static_cast<int>(order)) << "leave one flight out";
        EXPECT_EQ(to_string(several.held_back), "leave one flight out");
        EXPECT_EQ(several.folds, 4U);
        const auto alone = select_order(flight::Phase::cruise, flights_of_order(order, 1, 2), {}, {});
        EXPECT_EQ(alone.order, static_cast<int>(order)) << "blocks of time";
        EXPECT_EQ(to_string(alone.held_back), "blocks of time");
        EXPECT_EQ(alone.folds, 5U);
    }
}

TEST(OrderSelection, ShowsTheErrorOfEveryOrder) {
    const auto choice = select_order(flight::Phase::cruise, flights_of_order(3, 3, 1), {}, {});
    ASSERT_EQ(choice.errors.size(), 7U);
    for (int order = 0; order <= 6; ++order) {
        const auto& error = choice.errors[static_cast<std::size_t>(order)];
        EXPECT_EQ(error.order, order);
        ASSERT_TRUE(error.rms_w) << error.reason;
        EXPECT_GE(*error.excess_mse_w2, 0.0);
        if (order < 3) {
            EXPECT_GT(*error.rms_w, 0.3);
        }
    }
    EXPECT_NEAR(*choice.errors[3].rms_w, 0.1, 0.02);
    EXPECT_EQ(*choice.errors[static_cast<std::size_t>(choice.best)].excess_mse_w2, 0.0);
}

TEST(OrderSelection, PassesOverOrdersThatTheSamplesAreTooFewFor) {
    auto flights = test::record_flights(flight::Phase::landing, 3, 0.1, 1);
    for (auto& flight : flights) {
        flight.tau.clear();
        flight.power_w.clear();
        for (int i = 0; i < 9; ++i) {
            flight.tau.push_back((i + 0.5) / 9.0);
            flight.power_w.push_back(20.0 + i % 3);
        }
    }
    const auto choice = select_order(flight::Phase::landing, flights, {}, Weighting::agreement);
    EXPECT_TRUE(choice.errors[0].rms_w);
    EXPECT_FALSE(choice.errors[6].rms_w);
    EXPECT_NE(choice.errors[6].reason.find("9 samples"), std::string::npos) << choice.errors[6].reason;
    EXPECT_LE(choice.order, 3);
    EXPECT_THROW(select_order(flight::Phase::cruise, {}, {}, Weighting::agreement), NoResultError);
}

}  // namespace
}  // namespace flightwatt::mechanical
