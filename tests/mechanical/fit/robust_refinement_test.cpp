#include "mechanical/fit/robust_refinement.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/phase_curve.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// Two cruises of 0.1 W noise; every 25th sample of the second is 8 W too high.
std::vector<PhaseSamples> with_outliers() {
    auto flights = test::record_flights(flight::Phase::cruise, 2, 0.1, 1);
    flights[1].start_s = 1000.0;
    for (std::size_t j = 5; j < flights[1].tau.size(); j += 25) flights[1].power_w[j] += 8.0;
    return flights;
}

double off_by_w(const PhaseFit& fit, std::size_t flight) {
    const auto& curve = fit.flights[flight];
    const PhaseModel found{curve.fourier, curve.duration_s, {}, {}, 0, 0, {}, {}};
    return curve_rms_difference_w(found, test::published_model().phases[flight::Phase::cruise]);
}

TEST(RobustRefinement, OutliersHardlyMoveTheCurve) {
    const auto flights = with_outliers();
    EXPECT_GT(off_by_w(fit_phase(flight::Phase::cruise, flights), 1), 0.2);
    EXPECT_LT(off_by_w(fit_phase(flight::Phase::cruise, flights, {.loss = Loss::huber}), 1), 0.04);
}

TEST(RobustRefinement, KnowsTheNoiseInSpiteOfThem) {
    const auto fit = fit_phase(flight::Phase::cruise, with_outliers(), {.loss = Loss::huber});
    EXPECT_NEAR(fit.loss_scale_w, 0.1, 0.015);
    EXPECT_GT(fit.rms_w, 0.5);  // that of all samples, the outliers among them
}

TEST(RobustRefinement, StandsAtTheLeastLoss) {
    const auto flights = with_outliers();
    const auto fit = fit_phase(flight::Phase::cruise, flights, {.loss = Loss::huber});
    for (std::size_t i = 0; i < flights.size(); ++i) {
        // The weighted residuals are orthogonal to the constant and to the first cosine.
        double constant = 0.0;
        double cosine = 0.0;
        for (std::size_t j = 0; j < flights[i].tau.size(); ++j) {
            const double time_s = flights[i].tau[j] * flights[i].duration_s;
            const double residual_w = flights[i].power_w[j] - power_w(fit.flights[i].fourier, time_s);
            const double push_w = residual_w * sample_weight(Loss::huber, residual_w / fit.loss_scale_w);
            constant += push_w;
            cosine += push_w * std::cos(fit.theta_rad * flights[i].tau[j]);
        }
        EXPECT_NEAR(constant, 0.0, 1e-2);
        EXPECT_NEAR(cosine, 0.0, 1e-2);
    }
}

TEST(RobustRefinement, ExactSamplesStayExact) {
    const auto flights = test::record_flights(flight::Phase::cruise, 2, 0.0, 2);
    const auto fit = fit_phase(flight::Phase::cruise, flights, {.loss = Loss::huber});
    EXPECT_LT(fit.rms_w, 1e-9);
}

TEST(RobustLoss, TheInfluenceIsTheDerivativeOfThePush) {
    for (const auto loss : {Loss::none, Loss::huber}) {
        for (const double at : {-5.0, -1.0, 0.2, 1.2, 3.0}) {
            const auto push = [&](double residual) { return residual * sample_weight(loss, residual); };
            EXPECT_NEAR(sample_influence(loss, at), (push(at + 1e-6) - push(at - 1e-6)) / 2e-6, 1e-6);
        }
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
