// Discharges of the Thévenin circuit, against closed forms and limits.

#include "battery/battery.h"
#include "battery/discharge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// Open circuit 12.5 V - 1.5 V times the part drawn, 0.08 ohm, and 0.05 ohm with 25 s.
Battery straight_pack() {
    Battery pack{"straight", 0.0, 0.08, 2.0};
    pack.thevenin = TheveninCircuit{{{0.0, 100.0}, {11.0, 12.5}}, 0.05, 25.0};
    return pack;
}

TEST(TheveninDischarge, MeetsTheClosedFormOfConstantCurrent) {
    const auto pack = straight_pack();
    constexpr double current_a = 3.0;
    const auto exact = [&](double t) {
        return BatteryState{100.0 - 100.0 * current_a * t / 7200.0, 0.05 * current_a * (1.0 - std::exp(-t / 25.0))};
    };
    const auto load = [&](double t) { return current_a * terminal_voltage_v(pack, exact(t), current_a); };
    for (const double step_s : {0.02, 0.1, 1.0}) {
        const auto end = discharge(pack, {load, 0.0, 300.0}, {100.0, 0.0}, {step_s, 0.0});
        EXPECT_NEAR(end.soc_percent, exact(300.0).soc_percent, 1e-7) << step_s;
        EXPECT_NEAR(end.rc_voltage_v, exact(300.0).rc_voltage_v, 1e-8) << step_s;
    }
}

TEST(TheveninDischarge, DoesNotDependOnTheStep) {
    auto pack = straight_pack();
    pack.thevenin->open_circuit = {{0.0, 50.0, 100.0}, {10.0, 11.4, 12.5}};  // with a kink at 50 %
    const auto load = [](double t) { return 60.0 + 40.0 * std::sin(0.3 * t); };
    const auto coarse = discharge(pack, {load, 0.0, 900.0}, {100.0, 0.0}, {0.1, 0.0});
    const auto fine = discharge(pack, {load, 0.0, 900.0}, {100.0, 0.0}, {0.007, 0.0});
    EXPECT_LT(fine.soc_percent, 40.0);
    EXPECT_NEAR(coarse.soc_percent, fine.soc_percent, 1e-6);
    EXPECT_NEAR(coarse.rc_voltage_v, fine.rc_voltage_v, 1e-7);
    // Steps longer than the time constant would be unstable; they are cut.
    const auto longest = discharge(pack, {load, 0.0, 900.0}, {100.0, 0.0}, {1e3, 0.0});
    EXPECT_TRUE(std::isfinite(longest.soc_percent));
}

TEST(TheveninDischarge, FlatWithoutRcIsThePapersBattery) {
    const Battery paper{"", 11.1, 0.08, 2.0};
    auto flat = straight_pack();
    flat.thevenin = TheveninCircuit{{{0.0, 100.0}, {11.1, 11.1}}, 0.0, 1.0};
    const auto load = [](double t) { return 150.0 + 80.0 * std::sin(0.2 * t); };
    for (const double to_s : {100.0, 400.0, 900.0}) {
        const auto a = discharge(paper, {load, 0.0, to_s}, {100.0, 0.0}, {0.1, 5.0});
        const auto b = discharge(flat, {load, 0.0, to_s}, {100.0, 0.0}, {0.1, 5.0});
        EXPECT_NEAR(a.soc_percent, b.soc_percent, 1e-11);
        EXPECT_EQ(a.empty_at_s.has_value(), b.empty_at_s.has_value());
        EXPECT_NEAR(a.empty_at_s.value_or(0.0), b.empty_at_s.value_or(0.0), 1e-9);
    }
    // And with the resistance tending to 0, charge by constant voltage.
    flat.resistance_ohm = 1e-9;
    const auto end = discharge(flat, {[](double) { return 100.0; }, 0.0, 300.0}, {100.0, 0.0}, {0.1, 0.0});
    EXPECT_NEAR(end.soc_percent, 100.0 - 100.0 * 100.0 / 11.1 * 300.0 / 7200.0, 1e-6);
}

TEST(TheveninDischarge, EndsAtCutOff) {
    // Without RC and at constant current the terminal voltage falls along a straight line.
    auto pack = straight_pack();
    pack.thevenin->rc_resistance_ohm = 0.0;
    constexpr double current_a = 4.0;
    const auto load = [&](double t) { return current_a * (12.5 - 1.5 * current_a * t / 7200.0 - 0.08 * current_a); };
    const double exact_s = (12.5 - 0.32 - 11.7) / 1.5 * 7200.0 / current_a;
    for (const double step_s : {0.1, 0.33}) {
        const auto end = discharge(pack, {load, 0.0, 1000.0}, {100.0, 0.0}, {step_s, 11.7});
        ASSERT_TRUE(end.cut_off_at_s);
        EXPECT_FALSE(end.empty_at_s);
        EXPECT_NEAR(*end.cut_off_at_s, exact_s, 1e-6);
        EXPECT_NEAR(end.soc_percent, 100.0 - 100.0 * current_a * exact_s / 7200.0, 1e-8);
    }
    const auto at_once = discharge(pack, {load, 0.0, 10.0}, {100.0, 0.0}, {0.1, 12.3});
    EXPECT_EQ(at_once.cut_off_at_s, 0.0);
    EXPECT_EQ(at_once.soc_percent, 100.0);
    EXPECT_FALSE(discharge(pack, {load, 0.0, 100.0}, {100.0, 0.0}, {0.1, 11.7}).cut_off_at_s);
}

TEST(TheveninDischarge, TheRootIsTheCutOffTime) {
    // In a step of 10 s: what a bisection of whole discharges finds is the time reported.
    const auto pack = straight_pack();
    const auto load = [](double t) { return 20.0 + 3.0 * t; };
    const auto end = discharge(pack, {load, 0.0, 60.0}, {80.0, 0.0}, {10.0, 11.0});
    ASSERT_TRUE(end.cut_off_at_s);
    const auto voltage_at = [&](double t) {
        const auto there = discharge(pack, {load, 0.0, t}, {80.0, 0.0}, {0.01, 0.0});
        return terminal_voltage_v(pack, there, internal_current_a(pack, load(t), there));
    };
    EXPECT_NEAR(voltage_at(*end.cut_off_at_s), 11.0, 1e-4);  // steps of 10 s against 0.01 s
    const auto fine = discharge(pack, {load, 0.0, 60.0}, {80.0, 0.0}, {0.01, 11.0});
    EXPECT_NEAR(voltage_at(*fine.cut_off_at_s), 11.0, 1e-8);
}

TEST(TheveninDischarge, SaysWhenItCannotDeliver) {
    auto pack = straight_pack();
    pack.resistance_ohm = 0.5;  // full: 12.5^2 / 2 = 78.1 W
    const auto ramp = [](double t) { return t; };
    const auto end = discharge(pack, {ramp, 0.0, 100.0}, {100.0, 0.0}, {0.1, 0.0});
    ASSERT_TRUE(end.undeliverable);
    EXPECT_LT(end.undeliverable->limit_w, 78.1);  // less, as charge is drawn
    EXPECT_NEAR(end.undeliverable->power_w, end.undeliverable->limit_w, 1e-6);
    EXPECT_NEAR(end.undeliverable->time_s, end.undeliverable->power_w, 1e-9);
    EXPECT_TRUE(std::isfinite(end.soc_percent));
    // On the way there the voltage passes any cut-off above a half of that before the resistor.
    EXPECT_TRUE(discharge(pack, {ramp, 0.0, 100.0}, {100.0, 0.0}, {0.1, 9.0}).cut_off_at_s);
}

}  // namespace
}  // namespace flightwatt::battery
