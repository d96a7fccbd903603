// Capacity, missing charge and chemistry by the charts.

#include "battery/identification/chart_match.h"

#include "base/error.h"
#include "battery/identification/open_circuit.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// A pack of 2 Ah whose voltage is the chart's, flown from one state of charge to another.
ObservedOcv shown(double from_percent, double to_percent, int knots = 6, Chemistry chemistry = Chemistry::lipo) {
    ObservedOcv curve;
    curve.cells = 3;
    for (int k = 0; k <= knots; ++k) {
        const double drawn_percent = (from_percent - to_percent) * k / knots;
        curve.charge_ah.push_back(0.02 * drawn_percent);
        curve.voltage_v.push_back(3.0 * chart_voltage_v(chemistry, from_percent - drawn_percent));
    }
    curve.covariance_v2 = 1e-6 * Eigen::MatrixXd::Identity(knots + 1, knots + 1);
    curve.resting_voltage_v = curve.voltage_v.front();
    return curve;
}

TEST(ChartMatch, FindsTheCapacityOfAPackThatFollowsTheChart) {
    const auto posterior = capacity_posterior(shown(100.0, 10.0), std::nullopt);
    double sum = 0.0;
    for (const auto& scale : posterior) sum += scale.probability;
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_EQ(estimate_depletion_ah(posterior), 0.0);
    EXPECT_LT(capacity_quantile_ah(posterior, 0.025), 2.0);
    EXPECT_GT(capacity_quantile_ah(posterior, 0.975), 2.0);
    EXPECT_NEAR(capacity_quantile_ah(posterior, 0.5), 2.0, 0.4);
}

TEST(ChartMatch, RecognizesTheChemistryOfAFullPackFlownDeep) {
    for (const auto chemistry : {Chemistry::lipo, Chemistry::nmc, Chemistry::high_voltage}) {
        const auto posterior = capacity_posterior(shown(100.0, 10.0, 6, chemistry), std::nullopt);
        EXPECT_EQ(most_probable_chemistry(posterior), chemistry) << to_string(chemistry);
        EXPECT_NEAR(capacity_quantile_ah(posterior, 0.5), 2.0, 0.4) << to_string(chemistry);
    }
}

TEST(ChartMatch, TakesAPackAbove4V25ForOneOfHighVoltage) {
    auto curve = shown(100.0, 80.0);
    curve.resting_voltage_v = 3.0 * 4.2501;
    EXPECT_EQ(most_probable_chemistry(capacity_posterior(curve, std::nullopt)), Chemistry::high_voltage);
    curve.resting_voltage_v = 3.0 * 4.2499;
    EXPECT_EQ(most_probable_chemistry(capacity_posterior(curve, std::nullopt)), Chemistry::lipo);
}

TEST(ChartMatch, IsTheSurerTheDeeperWasFlown) {
    const auto deep = capacity_posterior(shown(100.0, 5.0), std::nullopt);
    const auto shallow = capacity_posterior(shown(100.0, 60.0), std::nullopt);
    const auto width_ah = [](const std::vector<CapacityHypothesis>& posterior) {
        return capacity_quantile_ah(posterior, 0.975) - capacity_quantile_ah(posterior, 0.025);
    };
    EXPECT_LT(width_ah(deep), width_ah(shallow) / 2.0);
}

TEST(ChartMatch, TakesNoSmoothnessForARuler) {
    const auto width = [](const std::vector<CapacityHypothesis>& posterior) {
        return capacity_quantile_ah(posterior, 0.975) / capacity_quantile_ah(posterior, 0.025);
    };
    const auto coarse = width(capacity_posterior(shown(80.0, 50.0, 3), std::nullopt));
    const auto fine = width(capacity_posterior(shown(80.0, 50.0, 12), std::nullopt));
    EXPECT_NEAR(fine, coarse, 0.1 * coarse) << "the same curve, reported at more knots";
    EXPECT_GT(fine, 2.0);
}

TEST(ChartMatch, LeavesAFullPackSomePercentShort) {
    const auto posterior = capacity_posterior(shown(100.0, 10.0), 2.0);
    const auto interval = depletion_interval_ah(posterior, 0.0, 0.0);
    EXPECT_NEAR(interval.low, 0.0, 1e-6);
    EXPECT_GT(interval.high, 0.02 * 2.0);
    EXPECT_LT(interval.high, 0.2 * 2.0);
}

TEST(ChartMatch, CountsAsFullWhereThatIsMoreProbable) {
    std::vector<CapacityHypothesis> posterior{{2.0, 0.1, 0.4, true}, {2.0, 0.3, 0.2, false}, {2.0, 0.9, 0.4, false}};
    EXPECT_EQ(estimate_depletion_ah(posterior), 0.3);
    posterior[0].probability = 0.7;
    EXPECT_EQ(estimate_depletion_ah(posterior), 0.0);
}

TEST(ChartMatch, SeesThatAPackIsNotFull) {
    const auto posterior = capacity_posterior(shown(60.0, 20.0), 2.0);
    const auto interval = depletion_interval_ah(posterior, 0.0, 0.0);
    EXPECT_GT(interval.low, 0.1);
    EXPECT_LT(interval.low, 0.8);
    EXPECT_GT(interval.high, 0.8);
    for (const auto& scale : posterior) EXPECT_EQ(scale.capacity_ah, 2.0);
}

TEST(ChartMatch, AddsTheErrorOfAFlightsPlace) {
    const std::vector<CapacityHypothesis> full{{2.0, 0.0, 1.0}};
    const auto interval = depletion_interval_ah(full, 0.5, 0.1);
    EXPECT_NEAR(interval.low, 0.5 - 1.96 * 0.1, 1e-3);
    EXPECT_NEAR(interval.high, 0.5 + 1.96 * 0.1, 1e-3);
    EXPECT_EQ(depletion_interval_ah(full, 0.0, 0.1).low, 0.0) << "nothing is fuller than full";
}

TEST(ChartMatch, IsLessSureOfAVoltageTheFurtherItIsFromWhatWasFlown) {
    const auto sd_v = [](double soc_percent) { return extrapolation_sd_v(Chemistry::lipo, soc_percent, 50.0); };
    EXPECT_DOUBLE_EQ(sd_v(50.0), chart_local_sd_v);
    EXPECT_NEAR(sd_v(30.0), chart_sd_v * std::sqrt(2.0 * (1.0 - std::exp(-0.125))), 0.005);
    for (double soc_percent = 0.0; soc_percent < 50.0; soc_percent += 5.0)
        EXPECT_GT(sd_v(soc_percent), sd_v(soc_percent + 5.0)) << soc_percent;
    EXPECT_GT(sd_v(0.0), 3.0 * sd_v(15.0)) << "where the chart is steep";
}

TEST(ChartMatch, HasNoCapacityBelowWhatWasDrawn) {
    EXPECT_TRUE(capacity_posterior(shown(100.0, 20.0), 1.0).empty());
    EXPECT_FALSE(capacity_posterior(shown(100.0, 20.0), 1.55).empty()) << "initial charges are not exact";
}

}  // namespace
}  // namespace flightwatt::battery
