#include "mechanical/model_difference.h"

#include "helpers/made_up_flights.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

Estimate estimate(double value, double below, double above) { return {value, Interval{value - below, value + above}}; }

TEST(ModelDifference, AddsIndependentIntervalsInSquares) {
    const auto interval = interval_of_difference(estimate(10.0, 1.0, 3.0), estimate(20.0, 4.0, 2.0));
    ASSERT_TRUE(interval);
    EXPECT_DOUBLE_EQ(interval->low, 10.0 - 5.0);
    EXPECT_DOUBLE_EQ(interval->high, 10.0 + std::sqrt(1.0 + 4.0));
}

TEST(ModelDifference, NeedsBothIntervals) { EXPECT_FALSE(interval_of_difference({1.0, {}}, estimate(2.0, 1.0, 1.0))); }

TEST(ModelDifference, FindsNothingBetweenAModelAndItself) {
    const auto model = test::published_model();
    const auto rows = model_difference(model, model);
    ASSERT_FALSE(rows.empty());
    for (const auto& row : rows) {
        EXPECT_EQ(difference_of(row), 0.0) << row.part << ' ' << row.quantity;
        EXPECT_FALSE(is_significant(row).value_or(false)) << row.part << ' ' << row.quantity;
    }
}

TEST(ModelDifference, NamesTheLevelThatWasRaised) {
    const auto a = test::published_model();
    auto b = a;
    b.phases[flight::Phase::cruise].fourier.a0_w += 2.0;
    for (const auto& row : model_difference(a, b)) {
        const bool of_level = row.quantity == "a0_w" || row.quantity == "mean_power_w" || row.quantity == "curve_w";
        if (row.part == "cruise" && of_level) {
            EXPECT_NEAR(*difference_of(row), 2.0, 1e-9) << row.quantity;
        }
        if (row.part != "cruise") {
            EXPECT_EQ(difference_of(row), 0.0) << row.part << ' ' << row.quantity;
        }
    }
}

TEST(ModelDifference, ComparesTheMeansOfTheFlightsAndNotThoseOfTheirCurves) {
    auto a = test::published_model();
    const auto means = [](double first_w, double second_w) {
        std::vector<FlightContribution> flights(2);
        flights[0].flight = "first";
        flights[1].flight = "second";
        flights[0].phases[flight::Phase::cruise] = PhaseContribution{.weight = 0.25, .mean_power_w = first_w};
        flights[1].phases[flight::Phase::cruise] = PhaseContribution{.weight = 0.75, .mean_power_w = second_w};
        for (auto& flight : flights) flight.phases[flight::Phase::cruise]->duration_s = 100.0;
        return flights;
    };
    auto b = a;
    a.flights = means(20.0, 24.0);
    b.flights = means(30.0, 26.0);
    std::size_t found = 0;
    for (const auto& row : model_difference(a, b)) {
        if (row.part != "cruise" || row.quantity != "mean_power_w") continue;
        ++found;
        EXPECT_DOUBLE_EQ(row.a->value, 23.0);
        EXPECT_DOUBLE_EQ(row.b->value, 27.0);
        EXPECT_TRUE(row.interval);
    }
    EXPECT_EQ(found, 1U);
}

TEST(ModelDifference, JudgesNoCoefficientThatOneModelLacks) {
    const auto a = test::published_model();
    auto b = a;
    auto& fourier = b.phases[flight::Phase::landing].fourier;
    fourier.cos_w.pop_back();
    fourier.sin_w.pop_back();
    const auto rows = model_difference(a, b);
    const auto row = std::ranges::find_if(
        rows, [](const Difference& one) { return one.part == "landing" && one.quantity == "a3_w"; });
    ASSERT_NE(row, rows.end());
    EXPECT_FALSE(row->b);
    EXPECT_FALSE(difference_of(*row));
    EXPECT_FALSE(is_significant(*row));
}

}  // namespace
}  // namespace flightwatt::mechanical
