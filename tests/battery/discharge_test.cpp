#include "battery/discharge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

const Battery real_pack{"", 11.1, 0.05, 3.2};
const Battery ideal_pack{"", 10.0, 0.0, 1.0};  // 36 kJ

std::function<double(double)> constant(double power) {
    return [power](double) { return power; };
}

double after_constant_percent(const Battery& battery, double power, double time_s, double from_percent = 100.0) {
    return from_percent - 100.0 * internal_current_a(battery, power) * time_s / (3600.0 * battery.capacity_ah);
}

TEST(Discharge, MeetsTheClosedFormOfConstantPower) {
    for (const double power : {1.0, 30.0, 120.0}) {
        for (const double step : {0.1, 0.7, 1000.0}) {
            const auto left = discharge(real_pack, {constant(power), 12.0, 600.0}, {80.0}, {step});
            EXPECT_NEAR(left.soc_percent, after_constant_percent(real_pack, power, 588.0, 80.0), 1e-9);
            EXPECT_FALSE(left.empty_at_s);
            EXPECT_FALSE(left.undeliverable);
        }
    }
}

TEST(Discharge, MeetsTheClosedFormOfARamp) {
    // P = c t without resistance: SoC falls by 100 c t^2 / 2 / (U Q); Runge-Kutta is exact on it.
    const auto left = discharge(ideal_pack, {[](double t) { return 0.4 * t; }, 0.0, 300.0}, {100.0}, {7.0});
    EXPECT_NEAR(left.soc_percent, 100.0 - 100.0 * 0.4 * 300.0 * 300.0 / 2.0 / 36000.0, 1e-10);
}

TEST(Discharge, ConvergesWithTheFourthPowerOfTheStep) {
    // P = 20 + 10 sin t without resistance has the integral 20 t + 10 (1 - cos t).
    const auto load = [](double t) { return 20.0 + 10.0 * std::sin(t); };
    const double exact = 100.0 - 100.0 * (20.0 * 100.0 + 10.0 * (1.0 - std::cos(100.0))) / 36000.0;
    const auto error = [&](double step) {
        return std::abs(discharge(ideal_pack, {load, 0.0, 100.0}, {100.0}, {step}).soc_percent - exact);
    };
    EXPECT_NEAR(error(1.0) / error(0.5), 16.0, 1.0);
    EXPECT_LT(error(0.1), 1e-8);
}

TEST(Discharge, DoesNotDependOnTheStepWithResistance) {
    const auto load = [](double t) { return 60.0 + 40.0 * std::sin(0.3 * t); };
    const double coarse = discharge(real_pack, {load, 0.0, 500.0}, {100.0}, {0.1}).soc_percent;
    const double fine = discharge(real_pack, {load, 0.0, 500.0}, {100.0}, {0.003}).soc_percent;
    EXPECT_NEAR(coarse, fine, 1e-8);
}

TEST(Discharge, FindsWhenItIsEmpty) {
    // 3 % of 36 kJ at 25 W last 43.2 s; with resistance the current of the closed form decides.
    for (const double step : {0.1, 5.0, 100.0}) {
        const auto left = discharge(ideal_pack, {constant(25.0), 10.0, 100.0}, {3.0}, {step});
        ASSERT_TRUE(left.empty_at_s);
        EXPECT_NEAR(*left.empty_at_s, 53.2, 1e-9);
        EXPECT_EQ(left.soc_percent, 0.0);
    }
    const auto left = discharge(real_pack, {constant(200.0), 0.0, 3600.0}, {50.0}, {0.1});
    ASSERT_TRUE(left.empty_at_s);
    EXPECT_NEAR(*left.empty_at_s, 0.5 * 3600.0 * 3.2 / internal_current_a(real_pack, 200.0), 1e-8);
}

TEST(Discharge, FindsWhenARampEmptiesIt) {
    // 0.4 t^2 / 2 J = 1 % of 36 kJ: t = sqrt(1800) s.
    const auto left = discharge(ideal_pack, {[](double t) { return 0.4 * t; }, 0.0, 100.0}, {1.0}, {0.1});
    ASSERT_TRUE(left.empty_at_s);
    EXPECT_NEAR(*left.empty_at_s, std::sqrt(1800.0), 1e-9);
}

TEST(Discharge, IsEmptyAtOnceIfItBeginsEmpty) {
    const auto left = discharge(ideal_pack, {constant(1.0), 5.0, 6.0}, {0.0}, {0.1});
    EXPECT_EQ(left.empty_at_s, 5.0);
}

TEST(Discharge, ChargesOnNegativePowerUpToFull) {
    EXPECT_NEAR(discharge(ideal_pack, {constant(-36.0), 0.0, 100.0}, {50.0}, {0.1}).soc_percent, 60.0, 1e-10);
    EXPECT_EQ(discharge(ideal_pack, {constant(-36.0), 0.0, 1000.0}, {95.0}, {0.1}).soc_percent, 100.0);
}

TEST(Discharge, SaysWhenItCannotDeliver) {
    const Battery weak{"", 10.0, 0.5, 1.0};  // at most 50 W
    const auto at_once = discharge(weak, {constant(50.001), 30.0, 40.0}, {100.0}, {0.1});
    ASSERT_TRUE(at_once.undeliverable);
    EXPECT_EQ(at_once.undeliverable->time_s, 30.0);
    EXPECT_EQ(at_once.undeliverable->power_w, 50.001);
    EXPECT_EQ(at_once.undeliverable->limit_w, 50.0);
    EXPECT_EQ(at_once.soc_percent, 100.0);
    const auto later = discharge(weak, {[](double t) { return 2.0 * t; }, 0.0, 40.0}, {100.0}, {0.1});
    ASSERT_TRUE(later.undeliverable);
    EXPECT_NEAR(later.undeliverable->time_s, 25.0, 1e-9);
    EXPECT_GT(later.undeliverable->power_w, 50.0);
    EXPECT_LT(later.soc_percent, 100.0);
    EXPECT_TRUE(std::isfinite(later.soc_percent));
    EXPECT_FALSE(discharge(weak, {constant(50.0), 0.0, 40.0}, {100.0}, {0.1}).undeliverable);
}

TEST(Discharge, CountsTheAccidentThatComesFirst) {
    const Battery weak{"", 10.0, 0.5, 1.0};
    const auto load = [](double t) { return 2.0 * t; };  // beyond the limit at 25 s
    const auto empty_first = discharge(weak, {load, 20.0, 40.0}, {0.5}, {20.0});
    EXPECT_TRUE(empty_first.empty_at_s);
    EXPECT_FALSE(empty_first.undeliverable);
}

TEST(Discharge, RefusesNonsense) {
    EXPECT_THROW(discharge(ideal_pack, {constant(1.0), 2.0, 1.0}, {50.0}, {0.1}), std::invalid_argument);
    EXPECT_THROW(discharge(ideal_pack, {constant(1.0), 0.0, 1.0}, {50.0}, {0.0}), std::invalid_argument);
    EXPECT_THROW(discharge(ideal_pack, {constant(1.0), 0.0, 1.0}, {101.0}, {0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace flightwatt::battery
