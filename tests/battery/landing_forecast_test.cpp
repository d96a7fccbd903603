#include "battery/landing_forecast.h"

#include "base/error.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// 10 V without resistance, 1 Ah: 36 kJ.
Battery plain() {
    Battery battery;
    battery.voltage_v = 10.0;
    battery.capacity_ah = 1.0;
    return battery;
}

Battery thevenin() {
    Battery battery;
    battery.capacity_ah = 1.0;
    battery.resistance_ohm = 0.1;
    battery.thevenin = TheveninCircuit{{{0.0, 100.0}, {9.0, 12.0}}, 0.05, 20.0};
    return battery;
}

TEST(LandingForecast, AddsUpEnergies) {
    const std::vector<ConstantLoad> ahead{{36.0, 500.0}, {18.0, 200.0}};  // half, and a tenth
    const auto forecast = forecast_landing(plain(), {80.0, 0.0}, ahead, 36.0);
    EXPECT_NEAR(forecast.soc_now_percent, 80.0, 1e-12);
    EXPECT_NEAR(forecast.soc_percent, 20.0, 1e-6);
    EXPECT_NEAR(forecast.voltage_v, 10.0, 1e-12);
    EXPECT_NEAR(forecast.endurance_s, 200.0, 1e-3);
    EXPECT_FALSE(forecast.fails_after_s.has_value());
}

TEST(LandingForecast, IsThatOfRungeKutta) {
    constexpr double near_percent = 1e-3;
    for (const double power_w : {-5.0, 0.0, 8.0, 20.0, 35.0}) {
        for (const double cutoff_v : {0.0, 9.8}) {
            const auto found = discharge_constant_load(thevenin(), {70.0, 0.1}, {power_w, 900.0}, cutoff_v);
            const Load load{[power_w](double) { return power_w; }, 0.0, 900.0};
            const auto reference = discharge(thevenin(), load, {70.0, 0.1}, {1.0, cutoff_v});
            EXPECT_NEAR(found.soc_percent, reference.soc_percent, near_percent) << power_w;
            EXPECT_NEAR(found.rc_voltage_v, reference.rc_voltage_v, 1e-3) << power_w;
            ASSERT_EQ(found.ended_at_s().has_value(), reference.ended_at_s().has_value()) << power_w;
            if (found.ended_at_s()) {
                EXPECT_NEAR(*found.ended_at_s(), *reference.ended_at_s(), 0.05) << power_w;
            }
        }
    }
}

TEST(LandingForecast, SaysWhenTheBatteryFails) {
    const std::vector<ConstantLoad> ahead{{36.0, 500.0}, {18.0, 600.0}};
    const auto forecast = forecast_landing(plain(), {60.0, 0.0}, ahead, 36.0);
    EXPECT_NEAR(forecast.fails_after_s.value(), 700.0, 1e-3);
    EXPECT_NEAR(forecast.soc_percent, 0.0, 1e-9);
    EXPECT_EQ(forecast.endurance_s, 0.0);
}

TEST(LandingForecast, KeepsTheReserveAndTheCutOff) {
    const std::vector<ConstantLoad> ahead{{36.0, 500.0}};  // half
    const auto kept = forecast_landing(plain(), {80.0, 0.0}, ahead, 36.0, {0.0, 10.0});
    EXPECT_TRUE(kept.keeps_reserve);
    EXPECT_NEAR(kept.endurance_s, 200.0, 1e-3);
    const auto missed = forecast_landing(plain(), {80.0, 0.0}, ahead, 36.0, {0.0, 40.0});
    EXPECT_FALSE(missed.keeps_reserve);
    EXPECT_EQ(missed.endurance_s, 0.0);
    EXPECT_FALSE(missed.fails_after_s);
    auto battery = thevenin();  // 9 V + 0.03 V a percent, at rest
    battery.resistance_ohm = 0.0;
    battery.thevenin->rc_resistance_ohm = 0.0;
    const auto cut_off = forecast_landing(battery, {80.0, 0.0}, ahead, 36.0, {10.5, 0.0});
    ASSERT_TRUE(cut_off.fails_after_s);
    EXPECT_NEAR(cut_off.soc_percent, 50.0, 1e-3);
    EXPECT_FALSE(cut_off.keeps_reserve);
    const auto later =
        forecast_landing(battery, {100.0, 0.0}, std::vector<ConstantLoad>{{36.0, 10.0}}, 36.0, {10.5, 0.0});
    EXPECT_LT(later.endurance_s,
              forecast_landing(battery, {100.0, 0.0}, std::vector<ConstantLoad>{{36.0, 10.0}}, 36.0).endurance_s);
}

TEST(LandingForecast, SkipsStretchesThatTakeNoTime) {
    const std::vector<ConstantLoad> ahead{{36.0, 0.0}, {18.0, 200.0}};
    EXPECT_NEAR(forecast_landing(plain(), {80.0, 0.0}, ahead, 36.0).soc_percent, 70.0, 1e-6);
}

TEST(LandingForecast, FindsTheChargeOfAVoltageAtRest) {
    EXPECT_NEAR(resting_soc_percent(thevenin(), 10.5), 50.0, 1e-9);
    EXPECT_NEAR(resting_soc_percent(thevenin(), 20.0), 100.0, 1e-9);
    EXPECT_NEAR(resting_soc_percent(thevenin(), 1.0), 0.0, 1e-9);
}

TEST(LandingForecast, TheChargeOfAPartUsedPackIsLessCertain) {
    EXPECT_NEAR(resting_soc_sd_percent(thevenin(), 12.0), 1.0, 1e-9) << "10 mV a cell of three, 30 mV a point";
    EXPECT_NEAR(resting_soc_sd_percent(thevenin(), 11.0), std::hypot(1.0, 10.0), 1e-9) << "0.3 of the fall of 1 V";
    auto uncertain = thevenin();
    uncertain.intervals.open_circuit_standard_error_v = {0.06, 0.06};
    EXPECT_NEAR(resting_soc_sd_percent(uncertain, 12.0), std::hypot(1.0, 2.0), 1e-9);
}

TEST(LandingForecast, StartsFromWhatWasDrawn) {
    DischargeRecord record;
    for (int i = 0; i <= 200; ++i) {
        record.time_s.push_back(i);
        record.voltage_v.push_back(11.0);
        record.current_a.push_back(3.6);
        record.mean_current_a.push_back(3.6);
        record.charge_ah.push_back(0.001 * i);
        record.used.push_back(true);
    }
    const auto state = state_after(thevenin(), record, 90.0);
    EXPECT_NEAR(state.soc_percent, 70.0, 1e-9);
    EXPECT_NEAR(state.rc_voltage_v, 0.18, 0.001);  // ten time constants at 3.6 A
    EXPECT_EQ(state_after(plain(), record, 90.0).rc_voltage_v, 0.0);
    EXPECT_THROW(state_after(plain(), record, 10.0), NoResultError);
}

}  // namespace
}  // namespace flightwatt::battery
