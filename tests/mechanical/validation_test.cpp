#include "mechanical/validation.h"

#include "base/error.h"
#include "base/units.h"
#include "helpers/generated_flights.h"
#include "helpers/made_up_flights.h"
#include "mechanical/validation_score.h"

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
    const auto validated = leave_one_out(flights);
    ASSERT_EQ(validated.size(), 3u);
    EXPECT_THAT(model_names(validated), ElementsAre("fourier", "constant_mean", "nearest_flight"));
    for (const auto& model : model_names(validated)) {
        const auto score = score_of(validated, model, std::nullopt).value();
        EXPECT_EQ(score.flights, 3u);
        EXPECT_LT(score.mean_absolute_error_percent.value(), 0.5) << model;
    }
    EXPECT_FALSE(
        score_of(validated, "fourier", flight::Phase::landing)->mean_absolute_error_percent.has_value());
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
    EXPECT_LT(
        score_of(validated, "airspeed_cubed", flight::Phase::cruise)->mean_absolute_error_percent.value(),
        0.5);
    EXPECT_GT(
        score_of(validated, "constant_mean", flight::Phase::cruise)->mean_absolute_error_percent.value(),
        5.0);
}

/// How often a model's 95 % interval covers the truth of independent generated flights, over many fits.
double coverage(const std::string& model, std::optional<flight::Phase> phase, std::optional<double> until_s,
                int repeats = 25) {
    double sum = 0.0;
    for (int seed = 1; seed <= repeats; ++seed) {
        const auto validated = leave_one_out(generated(5, static_cast<unsigned>(seed), until_s));
        sum += score_of(validated, model, phase)->coverage_95.value();
    }
    return sum / repeats;
}

TEST(Validation, IntervalsCoverGeneratedFlights) {
    // 125 flights: 95 % +- 4 points is two standard deviations, more as the folds share flights.
    const double before = coverage("fourier", flight::Phase::cruise, std::nullopt);
    EXPECT_GE(before, 0.89);
    EXPECT_LE(before, 0.99);
}

TEST(Validation, IntervalsInFlightCoverGeneratedFlights) {
    // 95 % +- 3 points: two standard deviations of 250 flights, about.
    const double during = coverage("in_flight", flight::Phase::cruise, 300.0, 50);
    EXPECT_GE(during, 0.92);
    EXPECT_LE(during, 0.98);
    // These flights have a shape in common, which an even level does not know but allows for.
    EXPECT_GE(coverage("in_flight_constant", flight::Phase::cruise, 300.0, 50), 0.92);
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

}  // namespace
}  // namespace flightwatt::mechanical
