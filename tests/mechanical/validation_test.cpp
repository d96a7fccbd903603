#include "mechanical/validation.h"

#include "base/error.h"
#include "base/units.h"
#include "helpers/generated_flights.h"
#include "helpers/made_up_flights.h"

#include <map>
#include <optional>
#include <string>
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
    const auto validated = leave_one_out(flights, {}, {}, [&](std::size_t flight, std::size_t all) {
        done.push_back(flight);
        EXPECT_EQ(all, 3U);
    });
    EXPECT_THAT(done, ElementsAre(1U, 2U, 3U));
    ASSERT_EQ(validated.size(), 3u);
    EXPECT_THAT(model_names(validated), ElementsAre("fourier", "constant_mean", "nearest_flight"));
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
    for (const auto* model : {"fourier", "constant_mean", "nearest_flight"}) {
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
        flights, {}, {}, [&](std::size_t so_many, std::size_t) { done.push_back(so_many); }, 3);
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
    keep_scans(sharing, {});
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
    EXPECT_THROW(leave_one_out(flights), NoAnswerError);
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

TEST(Validation, UsesTheAirspeedWhereItWasMeasured) {
    std::mt19937 random(1);
    std::vector<MeasuredFlight> flights;
    double level_w = -3.0;
    for (const auto* name : {"a", "b", "c", "d"}) {
        auto truth = published_model().phases;
        truth[flight::Phase::cruise].fourier.a0_w += level_w += 2.0;
        flights.push_back(measured(name, truth, random));
        auto& cruise = *flights.back().samples.phases[flight::Phase::cruise];
        const double mean_w =
            units::joule_from_wh(*flights.back().energy_wh[flight::Phase::cruise]) / cruise.duration_s;
        cruise.airspeed_cubed_m3_per_s3 = 100.0 * mean_w;
    }
    const auto validated = leave_one_out(flights);
    EXPECT_LT(score_of(validated, "airspeed_cubed", flight::Phase::cruise)->mean_absolute_error_percent.value(), 0.5);
    EXPECT_GT(score_of(validated, "constant_mean", flight::Phase::cruise)->mean_absolute_error_percent.value(), 5.0);
}

/// How often the 95 % interval of each model covers the truth of independent generated flights, over many fits of five.
std::map<std::string, double> coverage(const std::vector<std::string>& models, std::optional<double> until_s,
                                       int repeats) {
    std::map<std::string, double> covered;
    for (int seed = 1; seed <= repeats; ++seed) {
        const auto validated = leave_one_out(generated(5, static_cast<unsigned>(seed), until_s));
        for (const auto& model : models)
            covered[model] += score_of(validated, model, flight::Phase::cruise)->coverage_95.value() / repeats;
    }
    return covered;
}

/// Of 20 intervals that hold the truth with 95 %, fewer than 15 do so once in 3,000 times; of halved ones half do.
TEST(Validation, IntervalsCoverAFewGeneratedFlights) {
    EXPECT_GE(coverage({"fourier"}, std::nullopt, 4)["fourier"], 0.75);
    EXPECT_GE(coverage({"in_flight"}, 300.0, 4)["in_flight"], 0.75);
}

TEST(ValidationStudy, IntervalsCoverGeneratedFlights) {
    // 125 flights: 95 % +- 4 points is two standard deviations, more as the folds share flights.
    const double before = coverage({"fourier"}, std::nullopt, 25)["fourier"];
    EXPECT_GE(before, 0.89);
    EXPECT_LE(before, 0.99);
}

TEST(ValidationStudy, IntervalsInFlightCoverGeneratedFlights) {
    // 95 % +- 3 points: two standard deviations of 250 flights, about.
    const auto during = coverage({"in_flight", "in_flight_constant"}, 300.0, 50);
    EXPECT_GE(during.at("in_flight"), 0.92);
    EXPECT_LE(during.at("in_flight"), 0.98);
    // These flights have a shape in common, which an even level does not know but allows for.
    EXPECT_GE(during.at("in_flight_constant"), 0.92);
}

TEST(Validation, InFlightBeatsBeforeFlightOnGeneratedFlights) {
    double before_wh = 0.0;
    double during_wh = 0.0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const auto validated = leave_one_out(generated(5, seed, 300.0));
        before_wh += score_of(validated, "fourier", flight::Phase::cruise)->mean_absolute_error_wh;
        during_wh += score_of(validated, "in_flight", flight::Phase::cruise)->mean_absolute_error_wh;
        EXPECT_FALSE(score_of(validated, "fourier", flight::Phase::takeoff).has_value());
    }
    EXPECT_LT(during_wh, 0.75 * before_wh);
}

using flight::Phase;

/// A cruise of that energy, predicted with a standard deviation that 30 degrees of freedom tell (none: unknown).
ValidatedFlight cruise(double measured_wh, double predicted_wh, std::optional<double> sd_wh) {
    ValidatedFlight flight;
    flight.measured_wh[Phase::cruise] = measured_wh;
    EnergyEstimate estimate;
    estimate.energy_wh = predicted_wh;
    estimate.uncertainty_known = sd_wh.has_value();
    if (sd_wh) add_share(estimate, {*sd_wh * *sd_wh, 30.0});
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
    flights[0].predictions[1].model = "airspeed_cubed";
    EXPECT_FALSE(score_of(flights, "airspeed_cubed", Phase::cruise)) << "the second flight was not predicted";
    EXPECT_THAT(model_names(flights), testing::ElementsAre("fourier", "airspeed_cubed"));
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
    EXPECT_FALSE(predicted_energy(flight, "nearest_flight", std::nullopt));
}

}  // namespace
}  // namespace flightwatt::mechanical
