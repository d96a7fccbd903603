// Physical models of multirotors: synthetic flights of known payloads, and some real ones.
#include "base/statistics.h"
#include "flight/load_flight.h"
#include "helpers/test_paths.h"
#include "mechanical/physical_fit.h"
#include "mechanical/prediction.h"
#include "mechanical/validation.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

constexpr RotorLoading loading{3.0, 0.37};

TermValues truth_of_terms() {
    TermValues truth;
    truth[PowerTerm::hover] = 1.5;
    truth[PowerTerm::constant] = 60.0;
    truth[PowerTerm::blade] = 0.3;
    truth[PowerTerm::drag] = 0.05;
    truth[PowerTerm::climb] = 35.0;
    return truth;
}

/// Climb, ten bins of hover and forward flight, and descent; flights differ by 1.5 % and drift by 4 W.
BinnedFlight multirotor(const std::string& name, double payload_kg, bool states_rotors, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> speed(0.5, 11.0);
    BinnedFlight flight{name, {}, false, "", true, true, {payload_kg, loading}};
    const double level = 1.0 + 0.015 * normal(random);
    constexpr int bins = 12;
    for (int i = 0; i < bins; ++i) {
        FlightBin bin;
        bin.phase = i == 0 ? flight::Phase::takeoff : i + 1 == bins ? flight::Phase::landing : flight::Phase::cruise;
        bin.start_s = default_bin_s * i;
        bin.duration_s = default_bin_s;
        bin.samples = 100;
        bin.airspeed_m_per_s = speed(random);
        const double climb = i == 0 ? 2.0 : i + 1 == bins ? -1.5 : 0.1 * normal(random);
        bin.values = term_values({bin.airspeed_m_per_s, climb}, flight.load);
        double power_w = 0.0;
        const auto truth = truth_of_terms();
        for (const auto term : all_power_terms) power_w += truth[term] * bin.values[term];
        bin.power_w = level * power_w + 4.0 * normal(random);
        bin.values[PowerTerm::induced] = bin.values[PowerTerm::turn] = 0.0;
        flight.bins.push_back(bin);
    }
    if (!states_rotors) {
        flight.load.rotors.reset();
        for (auto& bin : flight.bins) bin.values[PowerTerm::hover] = 0.0;
    }
    return flight;
}

double error_percent(const PhysicalModel& model, const BinnedFlight& flight) {
    double predicted = 0.0;
    double measured = 0.0;
    for (const auto& bin : flight.bins) {
        predicted += sum_of_terms_w(model, bin.values);
        measured += bin.power_w;
    }
    return 100.0 * std::abs(predicted / measured - 1.0);
}

std::vector<BinnedFlight> flights_of(const std::vector<double>& payloads_kg, bool states_rotors, std::mt19937& random) {
    std::vector<BinnedFlight> flights;
    for (const double payload_kg : payloads_kg)
        flights.push_back(multirotor(fmt::format("f{}", flights.size()), payload_kg, states_rotors, random));
    return flights;
}

/// Hover by momentum theory, W^1.5 / sqrt(2 density area); fast flight, W^2 / (2 density area V).
TEST(RotorcraftModel, InducedPowerIsGlauerts) {
    const double weight_n = 4.0 * 9.80665;
    const AircraftLoad load{1.0, loading};
    EXPECT_NEAR(induced_power_w(load, 0.0), std::pow(weight_n, 1.5) / std::sqrt(2.0 * 1.225 * 0.37), 1e-3);
    const double fast_w = weight_n * weight_n / (2.0 * 1.225 * 0.37 * 40.0);
    EXPECT_NEAR(induced_power_w(load, 40.0), fast_w, 2e-3 * fast_w);
    EXPECT_DOUBLE_EQ(induced_power_w({1.0, {}}, 5.0), 0.0);
}

/// With rotors stated by the momentum theory, without them in proportion to the payload.
TEST(RotorcraftModel, PredictsOtherPayloadsWithinThreePercent) {
    for (const bool states_rotors : {true, false}) {
        std::mt19937 random(7);
        const auto fit =
            fit_physical_model(flights_of({0.0, 0.2, 0.4, 0.6, 0.0, 0.2, 0.4, 0.6}, states_rotors, random));
        const auto carrying = states_rotors ? PowerTerm::hover : PowerTerm::payload;
        EXPECT_NE(std::ranges::find(fit.model.terms, carrying), fit.model.terms.end()) << states_rotors;
        std::vector<double> errors;
        for (int i = 0; i < 40; ++i)
            errors.push_back(error_percent(fit.model, multirotor("new", 0.1 * (i % 8), states_rotors, random)));
        EXPECT_LT(mean(errors), 3.0) << states_rotors;
        EXPECT_GT(mean(errors), 0.3) << "flights differ";
        EXPECT_NEAR(fit.model.load.payload_kg, 0.3, 1e-12);
        EXPECT_DOUBLE_EQ(fit.model.payload_kg->high, 0.6);
    }
}

/// The interval widens beyond the payloads flown.
TEST(RotorcraftModel, IntervalsShowExtrapolation) {
    std::mt19937 random(3);
    auto model = fit_physical_model(flights_of({0.0, 0.1, 0.2, 0.3}, false, random)).model;
    const auto sd_w = [&](double payload_kg) {
        model.load.payload_kg = payload_kg;
        return predicted_power(model, term_values({5.0}, model.load), 300.0).sd_w.value();
    };
    EXPECT_GT(sd_w(1.5), 2.0 * sd_w(0.15));
}

TEST(RotorcraftModel, WingsHaveNoRotorTerms) {
    std::mt19937 random(3);
    auto flights = flights_of({0.0, 0.1, 0.2, 0.3}, true, random);
    for (const auto& trial : fit_physical_model(flights).trials) {
        if (trial.term == PowerTerm::induced || trial.term == PowerTerm::turn) {
            EXPECT_EQ(trial.reason, "not tried: rotors carry, not wings");
        }
    }
    for (auto& flight : flights) flight.is_rotorcraft = false;
    for (const auto& trial : fit_physical_model(flights).trials) {
        if (trial.term == PowerTerm::hover || trial.term == PowerTerm::blade) {
            EXPECT_EQ(trial.reason, "not tried: wings carry, not rotors");
        }
    }
}

/// Eight real flights with different payloads: what the first minute shows halves the error at least.
TEST(RotorcraftModel, AMinuteOfARealFlightTellsItsPayload) {
    FLIGHTWATT_NEEDS_SHARED();
    if (!exists(test::shared_dir() / "m100")) GTEST_SKIP() << "../shared/m100 is not here";
    std::vector<MeasuredFlight> flights;
    for (const auto* number : {"10", "100", "101", "103", "104", "106", "107", "109"}) {
        const auto loaded = flight::load_flight(test::shared_dir() / "m100" / fmt::format("{}.csv", number), {});
        auto measured = extract_flights(loaded);
        ASSERT_EQ(measured.flights.size(), 1U) << number;
        auto& flight = flights.emplace_back(std::move(measured.flights.front()));
        flight.flown = progress_after_lift_off(loaded.series, loaded.phases.sorties.front(), 60.0);
        EXPECT_TRUE(flight.motion.is_rotorcraft);
        EXPECT_FALSE(flight.motion.bins.empty()) << flight.motion.no_bins_reason;
    }
    const auto validated = leave_one_out(flights);
    const auto before = score_of(validated, "constant_mean", std::nullopt).value();
    const auto in_flight = score_of(validated, "in_flight", std::nullopt).value();
    EXPECT_EQ(in_flight.flights, flights.size());
    EXPECT_LT(in_flight.mean_absolute_error_percent.value(), 0.5 * before.mean_absolute_error_percent.value());
}

}  // namespace
}  // namespace flightwatt::mechanical
