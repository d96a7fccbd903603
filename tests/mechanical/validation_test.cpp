#include "mechanical/validation.h"

#include "base/error.h"
#include "base/units.h"
#include "helpers/generated_flights.h"
#include "helpers/made_up_flights.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using test::generated;
using test::measured;
using test::published_model;
using testing::ElementsAre;

TEST(Validation, PredictsFlightsThatAreAllAlikeExactly) {
    std::mt19937 random(1);
    std::vector<MeasuredFlight> flights;
    for (const auto* name : {"a", "b", "c"}) {
        flights.push_back(measured(name, published_model().phases, random));
    }
    std::vector<std::size_t> done;
    const auto validated = leave_one_out(flights, {}, [&](std::size_t flight, std::size_t all) {
        done.push_back(flight);
        EXPECT_EQ(all, 3U);
    });
    EXPECT_THAT(done, ElementsAre(1U, 2U, 3U));
    ASSERT_EQ(validated.size(), 3u);
    EXPECT_THAT(model_names(validated), ElementsAre("fourier", "constant_mean"));
    for (const auto& model : model_names(validated)) {
        const auto score = score_of(validated, model, std::nullopt).value();
        EXPECT_EQ(score.flights, 3u);
        EXPECT_LT(score.mean_absolute_error_percent.value(), 0.5) << model;
    }
    EXPECT_FALSE(score_of(validated, "fourier", flight::Phase::landing)->mean_absolute_error_percent.has_value());
}

/// A truth that the flight's own data must not leak into: the others' mean is what is predicted.
TEST(Validation, LeavesTheFlightOut) {
    std::mt19937 random(1);
    auto stray = published_model().phases;
    for (const auto phase : flight::all_phases) stray[phase].fourier.a0_w += 10.0;
    const std::vector flights{measured("a", published_model().phases, random),
                              measured("b", published_model().phases, random), measured("c", stray, random)};
    const auto validated = leave_one_out(flights);
    for (const auto* model : {"fourier", "constant_mean"}) {
        const auto energy = predicted_energy(validated[2], model, flight::Phase::cruise).value();
        EXPECT_NEAR(energy.estimate.energy_wh - energy.measured_wh, -10.0 * 600.0 / 3600.0, 0.05) << model;
    }
}

/// In groups neither it nor the other strays of its group are among those that predict it.
TEST(Validation, LeavesGroupsOut) {
    std::mt19937 random(1);
    auto stray = published_model().phases;
    for (const auto phase : flight::all_phases) stray[phase].fourier.a0_w += 10.0;
    std::vector<MeasuredFlight> flights;
    for (int i = 0; i < 6; ++i)
        flights.push_back(measured(fmt::format("{}", i), i % 3 == 2 ? stray : published_model().phases, random));
    std::vector<std::size_t> done;
    const auto validated = leave_one_out(
        flights, {}, [&](std::size_t so_many, std::size_t) { done.push_back(so_many); }, 3);
    EXPECT_THAT(done, ElementsAre(1U, 2U, 3U));
    for (const auto i : {2U, 5U}) {
        EXPECT_EQ(validated[i].flight, fmt::format("{}", i));
        const auto energy = predicted_energy(validated[i], "fourier", flight::Phase::cruise).value();
        EXPECT_NEAR(energy.estimate.energy_wh - energy.measured_wh, -10.0 * 600.0 / 3600.0, 0.05);
    }
}

/// The scans for the frequency are shared: of all flights one each, whatever is left out.
TEST(Validation, SaysOfSharedScansWhatFitsWithoutThemSay) {
    std::mt19937 random(3);
    std::vector<FlightSamples> flights;
    for (const auto* name : {"a", "b", "c", "d"})
        flights.push_back(measured(name, published_model().phases, random).samples);
    auto sharing = flights;
    cache_scans(sharing, {});
    for (const auto phase : flight::all_phases) {
        auto some = samples_of_phase(flights, phase);
        auto some_sharing = samples_of_phase(sharing, phase);
        for (const auto& samples : some_sharing) EXPECT_NE(samples.scan, nullptr) << to_string(phase);
        some.pop_back();
        some_sharing.pop_back();
        const auto alone = fit_phase_model(phase, some, {});
        const auto shared = fit_phase_model(phase, some_sharing, {});
        EXPECT_NEAR(shared.fit.theta_rad, alone.fit.theta_rad, 1e-9 * alone.fit.theta_rad);
        EXPECT_NEAR(shared.model.fourier.a0_w, alone.model.fourier.a0_w, 1e-9 * alone.model.fourier.a0_w);
    }
}

TEST(Validation, NeedsTwoFlightsAndGivesIntervalsFromThree) {
    std::mt19937 random(1);
    std::vector flights{measured("a", published_model().phases, random)};
    EXPECT_THROW(leave_one_out(flights), NoResultError);
    flights.push_back(measured("b", published_model().phases, random));
    EXPECT_FALSE(score_of(leave_one_out(flights), "fourier", std::nullopt)->coverage_95.has_value());
    flights.push_back(measured("c", published_model().phases, random));
    EXPECT_TRUE(score_of(leave_one_out(flights), "fourier", std::nullopt)->coverage_95.has_value());
}

TEST(Validation, PredictsOnlyWhatIsThere) {
    std::mt19937 random(1);
    std::vector<MeasuredFlight> flights;
    for (const auto* name : {"a", "b", "c"}) {
        flights.push_back(measured(name, published_model().phases, random));
    }
    flights[0].samples.phases[flight::Phase::takeoff].reset();
    flights[0].energy_wh[flight::Phase::takeoff].reset();
    for (auto& flight : flights) flight.samples.phases[flight::Phase::landing].reset();
    const auto validated = leave_one_out(flights);
    EXPECT_EQ(score_of(validated, "fourier", flight::Phase::takeoff)->flights, 2u);
    EXPECT_EQ(score_of(validated, "fourier", flight::Phase::cruise)->flights, 3u);
    EXPECT_FALSE(score_of(validated, "fourier", flight::Phase::landing).has_value());
    EXPECT_EQ(score_of(validated, "fourier", std::nullopt)->flights, 3u);
}

/// Errors of the cruises of independent generated flights, in half widths of their 95 % intervals, rising.
std::vector<double> errors_in_half_widths(const std::string& model, double until_s) {
    std::vector<double> errors;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        for (const auto& flight : leave_one_out(generated(5, seed, until_s))) {
            const auto prediction = predicted_energy(flight, model, flight::Phase::cruise).value();
            const auto interval = interval_95(prediction.estimate).value();
            const double half_width_wh = 0.5 * (interval.high - interval.low);
            errors.push_back(std::abs(prediction.estimate.energy_wh - prediction.measured_wh) / half_width_wh);
        }
    }
    std::sort(errors.begin(), errors.end());
    return errors;
}

/// 20 flights, of which an interval of 95 % misses at most 4 but once in 400 times. The median error shows intervals of
/// half or double the width; scripts/check coverage counts many more flights.
TEST(Validation, IntervalsCoverAFewGeneratedFlights) {
    for (const auto* model : {"fourier", "in_flight"}) {
        const auto errors = errors_in_half_widths(model, 300.0);
        EXPECT_LE(errors[15], 1.0) << model;
        EXPECT_GT(errors[10], 0.15) << model;
        EXPECT_LT(errors[10], 0.42) << model;
    }
}

TEST(Validation, InFlightBeatsBeforeFlightOnGeneratedFlights) {
    double before_wh = 0.0;
    double during_wh = 0.0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const auto validated = leave_one_out(generated(5, seed, 300.0));
        before_wh += score_of(validated, "fourier", flight::Phase::cruise)->mean_absolute_error_wh;
        during_wh += score_of(validated, "in_flight", flight::Phase::cruise)->mean_absolute_error_wh;
        EXPECT_FALSE(score_of(validated, "fourier", flight::Phase::takeoff).has_value());
    }
    EXPECT_LT(during_wh, 0.75 * before_wh);
}

using flight::Phase;

/// A cruise of that energy, predicted with a standard deviation that 30 degrees of freedom show (none: unknown).
ValidatedFlight cruise(double measured_wh, double predicted_wh, std::optional<double> sd_wh) {
    ValidatedFlight flight;
    flight.measured_wh[Phase::cruise] = measured_wh;
    EnergyEstimate estimate;
    estimate.energy_wh = predicted_wh;
    estimate.uncertainty_known = sd_wh.has_value();
    if (sd_wh) add_variance(estimate, *sd_wh * *sd_wh, 30.0);
    FlightPrediction prediction;
    prediction.model = "fourier";
    prediction.phases[Phase::cruise] = estimate;
    flight.predictions.push_back(prediction);
    return flight;
}

TEST(ScoreOf, AveragesTheErrorsOfTheFlights) {
    const std::vector flights{cruise(4.0, 4.2, 0.2), cruise(5.0, 4.9, 0.2), cruise(4.0, 5.0, 0.2)};
    const auto score = score_of(flights, "fourier", Phase::cruise).value();
    EXPECT_EQ(score.flights, 3U);
    EXPECT_NEAR(score.mean_absolute_error_wh, (0.2 + 0.1 + 1.0) / 3.0, 1e-12);
    EXPECT_NEAR(score.bias_wh, (0.2 - 0.1 + 1.0) / 3.0, 1e-12);
    EXPECT_NEAR(score.mean_absolute_error_percent.value(), (5.0 + 2.0 + 25.0) / 3.0, 1e-9);
    EXPECT_NEAR(score.coverage_95.value(), 2.0 / 3.0, 1e-12) << "+-0.41 Wh";
}

TEST(ScoreOf, HasNoCoverageWithoutIntervals) {
    const std::vector flights{cruise(4.0, 4.2, {}), cruise(5.0, 4.9, {})};
    EXPECT_FALSE(score_of(flights, "fourier", Phase::cruise)->coverage_95);
}

TEST(ScoreOf, HasNoPercentOfLandings) {
    auto landing = cruise(4.0, 4.2, 0.2);
    landing.measured_wh[Phase::landing] = landing.measured_wh[Phase::cruise];
    landing.predictions[0].phases[Phase::landing] = landing.predictions[0].phases[Phase::cruise];
    const std::vector flights{landing};
    EXPECT_FALSE(score_of(flights, "fourier", Phase::landing)->mean_absolute_error_percent);
    EXPECT_TRUE(score_of(flights, "fourier", Phase::cruise)->mean_absolute_error_percent);
}

TEST(ScoreOf, IsOfTheModelsThatPredictedAllThatAnotherDid) {
    auto flights = std::vector{cruise(4.0, 4.2, 0.2), cruise(5.0, 4.9, 0.2)};
    EXPECT_FALSE(score_of(flights, "constant_mean", Phase::cruise));
    EXPECT_FALSE(score_of(flights, "fourier", Phase::takeoff)) << "no flight has one";
    flights[0].predictions.push_back(flights[0].predictions[0]);
    flights[0].predictions[1].model = "physical";
    EXPECT_FALSE(score_of(flights, "physical", Phase::cruise)) << "the second flight was not predicted";
    EXPECT_THAT(model_names(flights), testing::ElementsAre("fourier", "physical"));
}

TEST(ScoreOf, HasNoCoverageWhereAFlightHasNoInterval) {
    std::vector<ValidatedFlight> flights{cruise(4.0, 4.2, 0.3), cruise(4.0, 4.2, 0.3)};
    EXPECT_EQ(score_of(flights, "fourier", std::nullopt)->coverage_95, 1.0);
    flights[1].predictions[0].phases[Phase::cruise]->uncertainty_known = false;
    EXPECT_FALSE(score_of(flights, "fourier", std::nullopt)->coverage_95) << "one of two flights is no coverage";
}

TEST(PredictedEnergy, OfTheWholeIsTheSumOfWhatWasMeasured) {
    auto flight = cruise(4.0, 4.2, 0.3);
    flight.measured_wh[Phase::takeoff] = 0.25;
    EXPECT_FALSE(predicted_energy(flight, "fourier", std::nullopt)) << "the take-off was not predicted";
    auto takeoff = *flight.predictions[0].phases[Phase::cruise];
    takeoff.energy_wh = 0.2;
    takeoff.variance_wh2 = 0.16;
    flight.predictions[0].phases[Phase::takeoff] = takeoff;
    flight.predictions[0].phases[Phase::landing] = takeoff;  // not measured, so not asked for
    const auto energy = predicted_energy(flight, "fourier", std::nullopt).value();
    EXPECT_DOUBLE_EQ(energy.measured_wh, 4.25);
    EXPECT_DOUBLE_EQ(energy.estimate.energy_wh, 4.4);
    EXPECT_DOUBLE_EQ(energy.estimate.variance_wh2, 0.09 + 0.16);
    EXPECT_FALSE(predicted_energy(flight, "another", std::nullopt));
}

}  // namespace
}  // namespace flightwatt::mechanical
