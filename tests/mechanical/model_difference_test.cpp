#include "mechanical/model_difference.h"

#include "helpers/made_up_flights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

Estimate estimate(double value, double below, double above) { return {value, Interval{value - below, value + above}}; }

TEST(ModelDifference, AddsIndependentIntervalsInSquares) {
    const auto interval = interval_of_difference(estimate(10.0, 1.0, 3.0), estimate(20.0, 4.0, 2.0), 0.0);
    ASSERT_TRUE(interval);
    EXPECT_DOUBLE_EQ(interval->low, 10.0 - 5.0);
    EXPECT_DOUBLE_EQ(interval->high, 10.0 + std::sqrt(1.0 + 4.0));
}

TEST(ModelDifference, IsNarrowerWhereEstimatesAreCorrelated) {
    const auto a = estimate(10.0, 3.0, 3.0);
    const auto b = estimate(12.0, 3.0, 3.0);
    EXPECT_LT(interval_of_difference(a, b, 0.0)->low, 0.0);
    EXPECT_GT(interval_of_difference(a, b, 0.9)->low, 0.0);
    EXPECT_DOUBLE_EQ(interval_of_difference(a, b, 1.0)->low, 2.0);
}

TEST(ModelDifference, IsNothingBetweenAnEstimateAndItself) {
    const auto skewed = estimate(10.0, 1.0, 3.0);
    const auto interval = interval_of_difference(skewed, skewed, 1.0);
    ASSERT_TRUE(interval);
    EXPECT_EQ(interval->low, 0.0);
    EXPECT_EQ(interval->high, 0.0);
    EXPECT_LT(interval_of_difference(skewed, skewed, 0.0)->low, 0.0);  // of other flights, the same by chance
}

TEST(ModelDifference, NeedsBothIntervals) {
    EXPECT_FALSE(interval_of_difference({1.0, {}}, estimate(2.0, 1.0, 1.0), 0.0));
}

TEST(ModelDifference, FindsNothingBetweenAModelAndItself) {
    const auto model = test::published_model();
    const auto rows = model_difference(model, model);
    ASSERT_FALSE(rows.empty());
    for (const auto& row : rows) {
        EXPECT_EQ(difference_of(row), 0.0) << row.part << ' ' << row.quantity;
        EXPECT_FALSE(is_significant(row).value_or(false)) << row.part << ' ' << row.quantity;
    }
}

TEST(ModelDifference, TellsFlightsOfOneNameApart) {
    auto model = test::published_model();
    model.flights.clear();
    for (const double mean_w : {25.0, 27.0, 29.0}) {
        FlightContribution flight{fmt::format("flight at {} W", mean_w), {}};
        for (const auto phase : flight::all_phases)
            flight.phases[phase] = PhaseContribution{1.0 / 3.0, 600.0, 0.3, 545, mean_w};
        model.flights.push_back(flight);
    }
    EXPECT_EQ(shared_flights(model, model).size(), model.flights.size());
    auto other = model;
    other.flights.front().phases[flight::Phase::cruise]->duration_s += 1.0;
    const auto shared = shared_flights(model, other);
    EXPECT_EQ(shared.size(), model.flights.size() - 1);
    EXPECT_EQ(std::ranges::find(shared, model.flights.front().flight), shared.end());
    const auto width = [](const std::vector<Difference>& rows) {
        const auto row = std::ranges::find_if(
            rows, [](const auto& r) { return r.part == "cruise" && r.quantity == "mean_power_w"; });
        return row->interval->high - row->interval->low;
    };
    EXPECT_GT(width(model_difference(model, other)), 1.2 * width(model_difference(model, model)) + 1e-9);
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
