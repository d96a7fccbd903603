#include "mechanical/model_fit.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/statistics.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/mechanical_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::HasSubstr;

std::vector<FlightSamples> made_up_flights(std::size_t count, double noise_w, unsigned seed) {
    std::vector<FlightSamples> flights(count);
    for (const auto phase : flight::all_phases) {
        const auto samples = test::record_flights(phase, count, noise_w, seed);
        for (std::size_t i = 0; i < count; ++i) {
            flights[i].flight = samples[i].flight;
            flights[i].phases[phase] = samples[i];
        }
    }
    return flights;
}

template <typename Error>
std::string message_of(const std::vector<FlightSamples>& flights, const ModelFitOptions& options = {}) {
    try {
        fit_model(flights, options).model;
    } catch (const Error& error) {
        return error.what();
    }
    return "fitted without complaint";
}

TEST(ModelFit, RegeneratesThePublishedModel) {
    const auto published = test::published_model();
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const auto model = fit_model(made_up_flights(6, 0.2, seed)).model;
        EXPECT_LE(rms_difference_w(model.phases[flight::Phase::takeoff], published.phases[flight::Phase::takeoff]),
                  0.10);
        EXPECT_LE(rms_difference_w(model.phases[flight::Phase::cruise], published.phases[flight::Phase::cruise]), 0.10);
        EXPECT_LE(rms_difference_w(model.phases[flight::Phase::landing], published.phases[flight::Phase::landing]),
                  0.30);
        // Noise of 0.2 W leaves the level of a series of less than a period open in the shorter phases.
        EXPECT_NEAR(model.phases[flight::Phase::cruise].fourier.a0_w,
                    published.phases[flight::Phase::cruise].fourier.a0_w, 0.27);
    }
}

/// Heights of the take-offs of flights that climbed to 30, 50 and 70 m in these times.
PhaseHeights heights_of(const std::vector<double>& durations_s) {
    auto flights = made_up_flights(3, 0.1, 1);
    for (std::size_t i = 0; i < 3; ++i) {
        auto& takeoff = *flights[i].phases[flight::Phase::takeoff];
        takeoff.duration_s = durations_s[i];
        takeoff.height_m = 30.0 + 20.0 * static_cast<double>(i);
    }
    const auto model = fit_model(flights, {.weighting = Weighting::uniform}).model;
    EXPECT_FALSE(model.phases[flight::Phase::cruise].heights);
    return model.phases[flight::Phase::takeoff].heights.value();
}

TEST(ModelFit, FindsTheRateOfFurtherHeight) {
    const auto heights = heights_of({20.0, 26.0, 32.0});
    EXPECT_NEAR(heights.mean_m, 50.0, 1e-9);
    EXPECT_EQ(heights.low_m, 30.0);
    EXPECT_EQ(heights.high_m, 70.0);
    EXPECT_NEAR(heights.m_per_s, 20.0 / 6.0, 1e-6) << "11 s do not grow with the height";
    EXPECT_NEAR(heights_of({20.0, 26.0, 38.0}).m_per_s, 50.0 / 26.0, 1e-6)
        << "so few flights show no rate above that of the quickest from the ground";
    EXPECT_NEAR(heights_of({30.0, 31.0, 32.0}).m_per_s, 2.0 * 70.0 / 32.0, 1e-6) << "no faster than twice that";
    EXPECT_NEAR(heights_of({15.0, 25.0, 35.0}).m_per_s, 2.0, 1e-9);
    EXPECT_NEAR(heights_of({35.0, 25.0, 15.0}).m_per_s, 70.0 / 15.0, 1e-9) << "times that fall with the height";
    EXPECT_NEAR(heights_of({10.0, 25.0, 50.0}).m_per_s, 50.0 / (85.0 / 3.0), 1e-9) << "no slower than their mean";
}

TEST(ModelFit, RegeneratesEveryCoefficientOfExactFlights) {
    const auto published = test::published_model();
    const auto model = fit_model(made_up_flights(4, 0.0, 1)).model;
    for (const auto phase : flight::all_phases) {
        const auto& is = model.phases[phase].fourier;
        const auto& was = published.phases[phase].fourier;
        EXPECT_NEAR(is.a0_w, was.a0_w, 1e-5);
        for (std::size_t n = 0; n < 3; ++n) {
            EXPECT_NEAR(is.cos_w[n], was.cos_w[n], 1e-5);
            EXPECT_NEAR(is.sin_w[n], was.sin_w[n], 1e-5);
        }
        EXPECT_NEAR(test::theta_rad(model.phases[phase]), test::theta_rad(published.phases[phase]), 1e-5);
    }
}

TEST(ModelFit, SaysHowItWasMade) {
    const auto flights = made_up_flights(3, 0.2, 2);
    const auto model = fit_model(flights, {.name = "made-up"}).model;
    EXPECT_EQ(model.name, "made-up");
    EXPECT_EQ(model.weighting, "agreement");
    EXPECT_EQ(model.description,
              "fitted to 3 flights: Fourier series of order 3 a phase, weights: agreement; "
              "flightwatt " FLIGHTWATT_VERSION);
    ASSERT_EQ(model.flights.size(), 3U);
    for (const auto phase : flight::all_phases) {
        const auto& result = model.phases[phase];
        double weights = 0.0;
        double duration_s = 0.0;
        double square_sum = 0.0;
        std::size_t samples = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& part = model.flights[i].phases[phase];
            ASSERT_TRUE(part);
            EXPECT_EQ(model.flights[i].flight, flights[i].flight);
            EXPECT_EQ(part->samples, flights[i].phases[phase]->tau.size());
            EXPECT_EQ(part->duration_s, flights[i].phases[phase]->duration_s);
            weights += part->weight;
            duration_s += part->weight * part->duration_s;
            square_sum += part->rms_w * part->rms_w * static_cast<double>(part->samples);
            samples += part->samples;
        }
        EXPECT_NEAR(weights, 1.0, 1e-14);
        EXPECT_NEAR(result.duration_s, duration_s, 1e-9);
        EXPECT_EQ(result.samples, samples);
        EXPECT_EQ(result.flights, 3U);
        ASSERT_TRUE(result.rms_w);
        EXPECT_NEAR(*result.rms_w, std::sqrt(square_sum / static_cast<double>(samples)), 1e-12);
        EXPECT_NEAR(*result.rms_w, 0.2, 0.05);
        ASSERT_TRUE(result.range);
        EXPECT_LT(result.range->low_rad, result.range->high_rad);
    }
}

TEST(ModelFit, IsReadBackFromItsFile) {
    const auto text = to_toml(fit_model(made_up_flights(2, 0.2, 3)).model);
    const auto path = test::scratch_dir() / "model.toml";
    write_file_atomically(path, text);
    EXPECT_EQ(to_toml(read_mechanical_model(path)), text);
}

TEST(ModelFit, AFlightMayLackAPhase) {
    auto flights = made_up_flights(3, 0.2, 4);
    flights[1].phases[flight::Phase::landing].reset();
    const auto model = fit_model(flights).model;
    EXPECT_EQ(model.phases[flight::Phase::landing].flights, 2U);
    EXPECT_EQ(model.phases[flight::Phase::cruise].flights, 3U);
    EXPECT_FALSE(model.flights[1].phases[flight::Phase::landing]);
    EXPECT_EQ(model.flights[2].phases[flight::Phase::landing]->weight, 0.5);
}

TEST(ModelFit, TheOrderOfTheFlightsDoesNotMatter) {
    auto flights = made_up_flights(4, 0.1, 5);
    const auto model = fit_model(flights).model;
    std::reverse(flights.begin(), flights.end());
    const auto turned = fit_model(flights).model;
    for (const auto phase : flight::all_phases) {
        EXPECT_NEAR(rms_difference_w(model.phases[phase], turned.phases[phase]), 0.0, 1e-6);
        EXPECT_NEAR(model.flights[0].phases[phase]->weight, turned.flights[3].phases[phase]->weight, 1e-6);
    }
}

TEST(ModelFit, KeepsWhatItsSpreadIsOf) {
    const auto flights = made_up_flights(3, 0.2, 8);
    const auto model = fit_model(flights).model;
    for (const auto phase : flight::all_phases) {
        std::vector<double> levels_w;
        for (const auto& flight : model.flights) levels_w.push_back(flight.phases[phase]->mean_power_w.value());
        EXPECT_NEAR(sample_sd(levels_w), model.phases[phase].level_spread->between_flight_sd_w, 1e-9);
    }
}

TEST(ModelFit, RefusesWhatHasNoAnswer) {
    auto flights = made_up_flights(2, 0.2, 7);
    EXPECT_THAT(message_of<NoResultError>({}), HasSubstr("those of a simulator by --simulated"));
    EXPECT_THAT(message_of<NoResultError>({}), HasSubstr("no flight is left to fit"))
        << "not that a take-off is missing: power faults leave out whole flights";
    auto without = flights;
    for (auto& flight : without) flight.phases[flight::Phase::landing].reset();
    EXPECT_THAT(message_of<NoResultError>(without), HasSubstr("no flight has a landing to fit"));
    auto twice = flights;
    twice[1].flight = twice[0].flight;
    EXPECT_THAT(message_of<UsageError>(twice), HasSubstr("'flight1' is given twice"));
    flights[0].phases[flight::Phase::takeoff]->tau.resize(5);
    flights[0].phases[flight::Phase::takeoff]->power_w.resize(5);
    const auto of_longer = fit_model(flights).model;
    EXPECT_EQ(of_longer.phases[flight::Phase::takeoff].flights, 1U) << "five samples determine no series of order 3";
    EXPECT_FALSE(of_longer.flights[0].phases[flight::Phase::takeoff]);
    EXPECT_TRUE(of_longer.flights[1].phases[flight::Phase::takeoff]);
}

TEST(ModelFit, HasTheMeanPowerWhereNoFlightDeterminesACurve) {
    auto flights = made_up_flights(2, 0.2, 7);
    for (auto& flight : flights) {
        auto& cruise = *flight.phases[flight::Phase::cruise];
        cruise.tau = {0.5};
        cruise.power_w = {40.0};
    }
    auto fit = fit_model(flights);
    const auto& cruise = fit.model.phases[flight::Phase::cruise];
    EXPECT_EQ(cruise.power.by, PowerBasis::mean);
    EXPECT_EQ(cruise.power.reason, "a Fourier series of order 3 needs 8 samples of a flight");
    EXPECT_DOUBLE_EQ(cruise.fourier.a0_w, 40.0);
    EXPECT_EQ(cruise.flights, 2U);
    analyse_model(fit);
    EXPECT_FALSE(cruise.errors) << "one sample a flight has no residual";
    EXPECT_TRUE(fit.model.phases[flight::Phase::landing].errors);
    EXPECT_EQ(fit.model.phases[flight::Phase::landing].power.by, PowerBasis::curve);
    const auto text = to_toml(fit.model);
    EXPECT_THAT(text, testing::Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace flightwatt::mechanical
