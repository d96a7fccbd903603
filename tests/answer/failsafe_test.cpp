// The card against flights that fly home from its thresholds, by a simulation of their own.

#include "answer/failsafe.h"

#include "base/error.h"
#include "battery/battery_toml.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using flight::Phase;
using ::testing::HasSubstr;

FailsafeRequest wing_request() {
    FailsafeRequest request;
    request.model = mechanical::read_predicting_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    request.battery = battery::read_battery(test::source_dir() / "fits/battery/synthetic-3s.toml");
    request.reserve_percent = 20.0;
    request.home_distance_m = 2000.0;
    request.wind.speed_m_per_s = 5.0;
    return request;
}

/// Flights of one aircraft as they really are.
struct TrueFleet {
    double cruise_w = 24.0;
    double cruise_sd = 0.08;  ///< between flights, of the power
    double landing_w = 9.0;
    double landing_sd_w = 1.0;
    double capacity_sd = 0.03;  ///< of the packs
    double wind_m_per_s = 5.0;
    double wind_sd_m_per_s = 1.0;
    double airspeed_m_per_s = 13.0;
};

double mean_of(const std::vector<double>& values) { return mean(values); }

/// The model of some flights of a fleet, with the variability that they show.
mechanical::MechanicalModel fitted_model(const TrueFleet& fleet, bool is_physical, std::size_t flights,
                                         std::mt19937& random) {
    std::normal_distribution<double> normal;
    auto model = wing_request().model;
    std::vector<double> levels;
    std::vector<double> landings_w;
    for (std::size_t i = 0; i < flights; ++i) {
        levels.push_back(1.0 + fleet.cruise_sd * normal(random));
        landings_w.push_back(fleet.landing_w + fleet.landing_sd_w * normal(random));
    }
    const auto set = [&](Phase phase, double mean_w, double sd_w) {
        model.phases[phase].fourier.a0_w = mean_w;
        model.phases[phase].flights = flights;
        model.phases[phase].level_spread = mechanical::VarianceComponents{flights, sd_w, 0.0, 1.0};
    };
    set(Phase::cruise, fleet.cruise_w * mean_of(levels), fleet.cruise_w * sample_sd(levels));
    set(Phase::landing, mean_of(landings_w), sample_sd(landings_w));
    if (!is_physical) {
        model.physical.reset();
        return model;
    }
    auto& physical = *model.physical;
    physical.terms = {mechanical::PowerTerm::drag};
    const double drag = fleet.cruise_w / std::pow(fleet.airspeed_m_per_s, 3) * mean_of(levels);
    physical.coefficients = {};
    physical.coefficients[mechanical::PowerTerm::drag] = drag;
    physical.level_sd = sample_sd(levels) / mean_of(levels);
    physical.degrees_of_freedom = static_cast<double>(flights - 1);
    physical.covariance = {{std::pow(drag * *physical.level_sd, 2) / static_cast<double>(flights)}};
    physical.drift_sd_w = 0.0;
    physical.speed_terms.reset();
    return model;
}

/// One flight home: whether it lands with the reserve when it turns at `used_mah`. Euler steps of a quarter second.
bool keeps_reserve(const FailsafeRequest& request, const TrueFleet& fleet, double used_mah, std::mt19937& random) {
    std::normal_distribution<double> normal;
    auto pack = request.battery;
    const double level = 1.0 + fleet.cruise_sd * normal(random);
    const double landing_w = fleet.landing_w + fleet.landing_sd_w * normal(random);
    pack.capacity_ah *= 1.0 + fleet.capacity_sd * normal(random);
    const double wind_m_per_s = fleet.wind_m_per_s + fleet.wind_sd_m_per_s * normal(random);
    const double home_s = *request.home_distance_m / (fleet.airspeed_m_per_s - wind_m_per_s);
    double left_ah = pack.capacity_ah - used_mah / 1000.0;
    constexpr double step_s = 0.25;
    for (double time_s = 0.0; time_s < home_s + request.model.phases[Phase::landing].duration_s; time_s += step_s) {
        const double power_w = time_s < home_s ? fleet.cruise_w * level : landing_w;
        const double soc_percent = 100.0 * left_ah / pack.capacity_ah;
        if (soc_percent <= 0.0) return false;
        left_ah -= internal_current_a(pack, power_w, {soc_percent, 0.0}) * step_s / 3600.0;
    }
    return left_ah >= pack.capacity_ah * *request.reserve_percent / 100.0;
}

/// The part of new flights that keep the reserve, of many fleets' models: its mean and standard error.
std::pair<double, double> kept_share(bool is_physical, double probability, std::size_t models, unsigned seed) {
    constexpr std::size_t flights = 60;
    const TrueFleet fleet;
    std::mt19937 random(seed);
    std::vector<double> shares;
    for (std::size_t i = 0; i < models; ++i) {
        auto request = wing_request();
        request.model = fitted_model(fleet, is_physical, 6, random);
        request.airspeed_m_per_s = fleet.airspeed_m_per_s;
        request.wind.speed_sd_m_per_s = fleet.wind_sd_m_per_s;
        request.probability = probability;
        request.battery.intervals.capacity_ah =
            Interval{request.battery.capacity_ah * (1.0 - 1.96 * fleet.capacity_sd),
                     request.battery.capacity_ah * (1.0 + 1.96 * fleet.capacity_sd)};
        const auto card = make_failsafe_card(request);
        double kept = 0.0;
        for (std::size_t k = 0; k < flights; ++k)
            kept += keeps_reserve(request, fleet, card.low.value().used_mah, random) ? 1.0 : 0.0;
        shares.push_back(kept / flights);
    }
    return {mean_of(shares), sample_sd(shares) / std::sqrt(static_cast<double>(models))};
}

void expect_share(bool is_physical, double probability, std::size_t models, unsigned seed) {
    const auto [share, error] = kept_share(is_physical, probability, models, seed);
    EXPECT_GT(share, probability - 3.0 * error - 0.005) << is_physical;
    EXPECT_LT(share, probability + 3.0 * error + 0.015) << is_physical << ": earlier than needed";
}

TEST(FailsafeCard, LowActionIsEarlyEnoughInTheStatedShareOfFlights) {
    expect_share(false, 0.9, 12, 71);
    expect_share(true, 0.9, 12, 72);
}

TEST(FailsafeCardStudy, LowActionIsEarlyEnoughInTheStatedShareOfFlights) {
    for (const bool is_physical : {false, true})
        for (const double probability : {0.8, 0.95, 0.99}) expect_share(is_physical, probability, 120, 73);
}

TEST(FailsafeCard, CountsFromTheCapacity) {
    const auto card = make_failsafe_card(wing_request());
    const auto& low = card.low.value();
    EXPECT_EQ(low.used_mah + low.remaining_mah, 3200);
    EXPECT_GE(low.soc_percent * 32.0, low.remaining_mah) << "rounded to the safe side";
    EXPECT_LT((low.soc_percent - 1) * 32.0, low.remaining_mah);
    EXPECT_LE(low.too_late.value(), 0.05);
    EXPECT_NEAR(low.too_late.value(), 0.05, 0.015);
    EXPECT_TRUE(low.too_late_95->low <= low.too_late && *low.too_late <= low.too_late_95->high);
}

TEST(FailsafeCard, LandsAtOnceWithHalfOfTheReserve) {
    const auto card = make_failsafe_card(wing_request());
    // 9 W for 50 s are 0.125 Wh, 0.35 % of the pack.
    EXPECT_EQ(card.critical.soc_percent, 11);
    EXPECT_GT(card.low->remaining_mah, card.critical.remaining_mah);
    EXPECT_LT(card.lands_short.value(), 0.05);
}

TEST(FailsafeCard, NeedsMoreAgainstAStrongerWindAndFromFarther) {
    const auto low_mah = [](double distance_m, double wind_m_per_s) {
        auto request = wing_request();
        request.home_distance_m = distance_m;
        request.wind.speed_m_per_s = wind_m_per_s;
        return make_failsafe_card(request).low.value().remaining_mah;
    };
    EXPECT_GT(low_mah(2000.0, 8.0), low_mah(2000.0, 5.0));
    EXPECT_GT(low_mah(3000.0, 5.0), low_mah(2000.0, 5.0));
    EXPECT_NEAR(low_mah(0.0, 5.0), 3200.0 * 0.2035, 10.0) << "at home: landing and reserve";
}

/// Whole flights that are predicted no better with drag made the fastest way home the cheapest.
TEST(FailsafeCard, HasTheDragThatTheFlightsShowOnAFasterWayHome) {
    using enum mechanical::PowerTerm;
    auto request = wing_request();
    auto& physical = *request.model.physical;
    physical.terms = {constant};
    physical.coefficients = {};
    physical.coefficients[constant] = 24.0;
    physical.covariance = {{0.01}};
    physical.level_sd = 0.05;
    physical.degrees_of_freedom = 4.0;
    physical.speed_terms = {{drag, induced}, {}, {{1e-8, 0.0}, {0.0, 1.0}}, 4.0};
    physical.speed_terms->coefficients[drag] = 0.006;
    physical.speed_terms->coefficients[induced] = 100.0;
    const auto at = [&](double airspeed_m_per_s) {
        request.airspeed_m_per_s = airspeed_m_per_s;
        return make_failsafe_card(request).low->remaining_mah;
    };
    EXPECT_GT(at(20.0), at(13.0));
}

TEST(FailsafeCard, TakesTheWindFromAheadUnlessTheCourseIsKnown) {
    auto request = wing_request();
    request.wind.from_deg = 90.0;
    const auto worst = make_failsafe_card(request);
    request.home_course_deg = 90.0;
    EXPECT_EQ(make_failsafe_card(request).low->remaining_mah, worst.low->remaining_mah);
    request.home_course_deg = 270.0;
    EXPECT_LT(make_failsafe_card(request).low->remaining_mah, worst.low->remaining_mah);
}

TEST(FailsafeCard, StatesTheWindOfAMissionAndTakesItFromAheadWhateverItsDirection) {
    auto request = wing_request();
    request.wind = {.speed_m_per_s = 4.0, .from_deg = 250.0, .speed_sd_m_per_s = 1.0};
    request.wind_is_of_mission = true;
    const auto card = make_failsafe_card(request);
    EXPECT_THAT(describe(card), HasSubstr("wind: 4 m/s with a standard deviation of 1 m/s, as the mission states, from "
                                          "ahead, the worst, all the way home"));
    request.wind.direction_sd_deg = 90.0;
    EXPECT_EQ(make_failsafe_card(request).low->remaining_mah, card.low->remaining_mah);
    request.wind.speed_m_per_s = 0.0;
    EXPECT_THAT(describe(make_failsafe_card(request)), HasSubstr("wind: 0 m/s with a standard deviation of 1 m/s"));
}

TEST(FailsafeCard, StatesThatPowersWithAPayloadAreNotMeasured) {
    auto request = wing_request();
    EXPECT_THAT(describe(make_failsafe_card(request)), HasSubstr("measured: landing: 50 s at 9.0 W, the mean of the "
                                                                 "flights\n"));
    request.payload = mission::PayloadBasis{0.3, true, "its power is assumed to be proportional to mass^1.5"};
    request.compute_w = 2.0;
    auto text = describe(make_failsafe_card(request));
    EXPECT_THAT(text, HasSubstr("assumption: power on the way home"));
    EXPECT_THAT(text,
                HasSubstr("assumption: landing: 50 s at 11.0 W, the mean of the flights, changed by the payload"));
    EXPECT_THAT(text, HasSubstr("assumption: payload: 0.3 kg, its power is assumed to be proportional to mass^1.5"));
    EXPECT_THAT(text, HasSubstr("assumption: computer: 2.0 W in these powers"));
    request.payload->is_assumed = false;
    text = describe(make_failsafe_card(request));
    EXPECT_THAT(text, HasSubstr("physics: power on the way home"));
    EXPECT_THAT(text, HasSubstr("physics: landing: 50 s"));
}

TEST(FailsafeCard, OfARotorcraftReturnsAsFastOverGroundInAnyWind) {
    auto request = wing_request();
    request.model.is_rotorcraft = true;
    request.wind.speed_m_per_s = 4.0;
    request.home_distance_m = 500.0;
    const double calm_m_per_s = request.model.physical->mean_airspeed_m_per_s;
    EXPECT_THAT(describe(make_failsafe_card(request)), HasSubstr(fmt::format("{:.1f} m/s", calm_m_per_s + 4.0)));
    request.wind.speed_m_per_s = 40.0;
    EXPECT_THAT(make_failsafe_card(request).low_missing, HasSubstr("does not suffice to return"));
}

TEST(FailsafeCard, HasNoLowActionWithoutItsInputs) {
    auto request = wing_request();
    request.home_distance_m.reset();
    auto card = make_failsafe_card(request);
    EXPECT_FALSE(card.low);
    EXPECT_FALSE(card.lands_short);
    EXPECT_THAT(card.low_missing, HasSubstr("distance"));
    EXPECT_EQ(card.critical.soc_percent, 11);
    EXPECT_THAT(describe(card), HasSubstr("Return: no value, the distance"));

    request.flown_distance_m = 1500.0;
    EXPECT_THAT(describe(make_failsafe_card(request)), HasSubstr("measured: distance: 1500 m, the largest"));

    request.wind.speed_m_per_s = 14.0;
    EXPECT_THAT(make_failsafe_card(request).low_missing, HasSubstr("no way home"));
    EXPECT_EQ(make_failsafe_card(request).home_distance_m, 1500.0);

    request.wind.speed_m_per_s = 5.0;
    request.home_distance_m = 100e3;
    EXPECT_THAT(make_failsafe_card(request).low_missing, HasSubstr("does not suffice to return"));

    request.model.physical.reset();
    EXPECT_THAT(make_failsafe_card(request).low_missing, HasSubstr("no airspeed"));
}

TEST(FailsafeCard, HasNoChanceOfASingleFlight) {
    auto request = wing_request();
    request.model.physical.reset();
    request.airspeed_m_per_s = 13.0;
    const auto known = make_failsafe_card(request);
    for (const auto phase : flight::all_phases) request.model.phases[phase].level_spread.reset();
    const auto card = make_failsafe_card(request);
    EXPECT_FALSE(card.chances_known);
    EXPECT_FALSE(card.low->too_late || card.low->too_late_95 || card.low->voltage->too_late || card.lands_short);
    EXPECT_GT(card.low->remaining_mah, known.low->remaining_mah) << "25 % instead of 8 %";
    EXPECT_THAT(describe(card), HasSubstr("too late: unknown"));
}

TEST(FailsafeCard, VoltageAloneIsEarlyEnough) {
    const auto card = make_failsafe_card(wing_request());
    const auto& low = card.low.value();
    EXPECT_LE(low.voltage_alone->too_late.value(), 0.05);
    EXPECT_GT(low.voltage->too_late.value(), low.voltage_alone->too_late.value());
    EXPECT_GT(low.voltage_alone->too_early.value(), low.voltage->too_early.value());
    auto settled = wing_request().battery;
    const double voltage_v = terminal_voltage_v(settled, {low.soc_percent * 1.0, 0.0}, low.current_a);
    EXPECT_NEAR(low.voltage->voltage_v, voltage_v, 0.02);
}

TEST(FailsafeCard, HasNoVoltageOfAConstantSource) {
    auto request = wing_request();
    request.battery = {"paper", 11.1, 0.1, 3.2};
    const auto card = make_failsafe_card(request);
    EXPECT_TRUE(card.low);
    EXPECT_FALSE(card.low->voltage || card.critical.voltage_alone || card.empty_voltage_v);
}

TEST(FailsafeCard, RefusesWhatIsNoProbabilityOrReserve) {
    auto request = wing_request();
    request.probability = 1.0;
    EXPECT_THROW(make_failsafe_card(request), UsageError);
    request = wing_request();
    request.reserve_percent = 100.0;
    EXPECT_THROW(make_failsafe_card(request), UsageError);
}

TEST(FailsafeCard, StatesWhichMonitorsCountThePacks) {
    auto request = wing_request();
    EXPECT_EQ(make_failsafe_card(request).monitors, "");
    request.battery.monitors = {{1, 0.55}, {2, 0.45}};
    const auto known = make_failsafe_card(request);
    EXPECT_THAT(known.monitors, HasSubstr("battery monitor 1 counts 55.0 % and battery monitor 2 counts 45.0 %"));
    EXPECT_THAT(describe(known), HasSubstr("measured: " + known.monitors));
    request.battery.monitors = {{1, 0.0}, {2, 0.0}};
    EXPECT_THAT(describe(make_failsafe_card(request)), HasSubstr("assumption: packs: the charge is that of all"));
}

}  // namespace
}  // namespace flightwatt::answer
