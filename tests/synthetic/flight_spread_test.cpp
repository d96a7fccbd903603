#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/mechanical_model.h"
#include "synthetic/synthetic_flight.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

using test::published_model;

/// One phase of all flights.
std::vector<mechanical::PhaseModel> phase_of(const std::vector<flight::PerPhase<mechanical::PhaseModel>>& flights,
                                             flight::Phase phase) {
    std::vector<mechanical::PhaseModel> result;
    for (const auto& flight : flights) result.push_back(flight[phase]);
    return result;
}

double at(const mechanical::PhaseModel& flight, double tau) { return power_w(flight.fourier, tau * flight.duration_s); }

void expect_mean(const std::vector<mechanical::PhaseModel>& flights, const mechanical::PhaseModel& model,
                 double tolerance) {
    mechanical::PhaseModel mean = model;
    mean.fourier = {0.0, 0.0, std::vector<double>(3), std::vector<double>(3)};
    mean.duration_s = 0.0;
    const double part = 1.0 / static_cast<double>(flights.size());
    for (const auto& flight : flights) {
        mean.duration_s += part * flight.duration_s;
        mean.fourier.a0_w += part * flight.fourier.a0_w;
        for (std::size_t n = 0; n < 3; ++n) {
            mean.fourier.cos_w[n] += part * flight.fourier.cos_w[n];
            mean.fourier.sin_w[n] += part * flight.fourier.sin_w[n];
        }
    }
    EXPECT_NEAR(mean.duration_s, model.duration_s, tolerance);
    EXPECT_NEAR(mean.fourier.a0_w, model.fourier.a0_w, tolerance);
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_NEAR(mean.fourier.cos_w[n], model.fourier.cos_w[n], tolerance);
        EXPECT_NEAR(mean.fourier.sin_w[n], model.fourier.sin_w[n], tolerance);
    }
}

TEST(Band, IsWideWhereThePaperSaysThatFlightsDiffer) {
    EXPECT_DOUBLE_EQ(band_w(flight::Phase::takeoff, 0.0), 1.5);
    EXPECT_DOUBLE_EQ(band_w(flight::Phase::takeoff, 1.0), 0.2);
    EXPECT_DOUBLE_EQ(band_w(flight::Phase::cruise, 0.0), band_w(flight::Phase::cruise, 0.7));
    EXPECT_DOUBLE_EQ(band_w(flight::Phase::landing, 0.0), 2.5);
    EXPECT_DOUBLE_EQ(band_w(flight::Phase::landing, 1.0), 2.5);
    EXPECT_LT(band_w(flight::Phase::landing, 0.5), 1.0);
    EXPECT_LT(band_w(flight::Phase::cruise, 0.5), band_w(flight::Phase::landing, 0.5));
}

TEST(DrawFlights, KeepsThePhasesFrequency) {
    const auto model = published_model();
    for (const auto phase : flight::all_phases) {
        for (const auto& flight : phase_of(draw_flights(model, 7, 3), phase)) {
            EXPECT_NEAR(test::theta_rad(flight), test::theta_rad(model.phases[phase]), 1e-9);
        }
    }
}

TEST(DrawFlights, DrawsOppositePairsWhoseMeanIsTheModel) {
    const auto model = published_model();
    const auto flights = draw_flights(model, 6, 1);
    ASSERT_EQ(flights.size(), 6U);
    for (const auto phase : flight::all_phases) {
        const auto drawn = phase_of(flights, phase);
        for (std::size_t i = 0; i < 6; i += 2) {
            expect_mean({drawn[i], drawn[i + 1]}, model.phases[phase], 1e-9);
            EXPECT_GT(rms_difference_w(drawn[i], drawn[i + 1]), 1e-3);
        }
        expect_mean(drawn, model.phases[phase], 1e-9);
    }
}

TEST(DrawFlights, DrawsTheModelWhereOneIsLeftOver) {
    const auto model = published_model();
    for (const std::size_t count : {1U, 5U}) {
        const auto flights = draw_flights(model, count, 1);
        ASSERT_EQ(flights.size(), count);
        for (const auto phase : flight::all_phases) {
            EXPECT_EQ(flights.back()[phase].duration_s, model.phases[phase].duration_s);
            EXPECT_EQ(flights.back()[phase].fourier.cos_w, model.phases[phase].fourier.cos_w);
            expect_mean(phase_of(flights, phase), model.phases[phase], 1e-9);
        }
    }
    EXPECT_TRUE(draw_flights(model, 0, 1).empty());
}

TEST(DrawFlights, DrawsTheSameFlightsOfTheSameSeed) {
    const auto model = published_model();
    const auto first = draw_flights(model, 4, 5);
    const auto again = draw_flights(model, 4, 5);
    const auto other = draw_flights(model, 4, 6);
    for (const auto phase : flight::all_phases) {
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(first[i][phase].duration_s, again[i][phase].duration_s);
            EXPECT_EQ(first[i][phase].fourier.sin_w, again[i][phase].fourier.sin_w);
            EXPECT_NE(first[i][phase].fourier.sin_w, other[i][phase].fourier.sin_w);
        }
    }
}

TEST(DrawFlights, SpreadsThemAsWideAsTheBand) {
    const auto model = published_model();
    constexpr std::size_t count = 2000;
    const auto flights = draw_flights(model, count, 1, {2.0, 0.0});
    for (const auto phase : flight::all_phases) {
        const auto drawn = phase_of(flights, phase);
        for (const double tau : {0.05, 0.3, 0.5, 0.7, 0.95}) {
            double squares = 0.0;
            for (const auto& flight : drawn) {
                const double difference_w = at(flight, tau) - at(model.phases[phase], tau);
                squares += difference_w * difference_w;
            }
            // Level and tilt are independent, the tilt half as strong. 10 % for the draw (1000 pairs: 2 %)
            // and for the series, which follows the band's shape only so far.
            const double tilt = 0.5 * (2.0 * tau - 1.0);
            const double expected_w = 2.0 * band_w(phase, tau) * std::sqrt(1.0 + tilt * tilt);
            EXPECT_NEAR(std::sqrt(squares / count) / expected_w, 1.0, 0.1) << to_string(phase) << tau;
        }
    }
}

TEST(DrawFlights, SpreadsDurationsEvenly) {
    const auto model = published_model();
    const auto flights = draw_flights(model, 400, 1);
    for (const auto phase : flight::all_phases) {
        const auto drawn = phase_of(flights, phase);
        const auto [shortest, longest] = std::minmax_element(
            drawn.begin(), drawn.end(), [](const auto& a, const auto& b) { return a.duration_s < b.duration_s; });
        EXPECT_GE(shortest->duration_s, 0.94 * model.phases[phase].duration_s);
        EXPECT_LE(shortest->duration_s, 0.95 * model.phases[phase].duration_s);
        EXPECT_LE(longest->duration_s, 1.06 * model.phases[phase].duration_s);
        EXPECT_GE(longest->duration_s, 1.05 * model.phases[phase].duration_s);
    }
}

TEST(DrawFlights, StretchesTheModelWhereNothingElseDiffers) {
    const auto model = published_model();
    for (const auto& flight : draw_flights(model, 4, 1, {0.0, 0.06})) {
        for (const auto phase : flight::all_phases) {
            EXPECT_NE(flight[phase].duration_s, model.phases[phase].duration_s);
            EXPECT_LT(rms_difference_w(flight[phase], model.phases[phase]), 1e-9);
        }
    }
}

TEST(DrawFlights, HasNoAnswerForAFrequencyThatShowsNothing) {
    auto model = published_model();
    model.phases[flight::Phase::cruise].fourier.omega_rad_per_s = 1e-12;
    EXPECT_THROW(draw_flights(model, 2, 1), NoResultError);
}

}  // namespace
}  // namespace flightwatt::synthetic
