#include "battery/battery_step.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

Battery pack() {
    Battery made{"pack", 0.0, 0.05, 2.0};
    made.thevenin = TheveninCircuit{{{0.0, 10.0, 40.0, 100.0}, {9.0, 10.8, 11.4, 12.5}}, 0.03, 30.0};
    return made;
}

TEST(BatteryStep, FindsWhereAParabolaCrossesZero) {
    EXPECT_NEAR((Parabola{1.0, 0.0, -1.0}).first_zero_crossing(), 0.5, 1e-15);
    EXPECT_NEAR((Parabola{0.75, -0.25, 0.75}).first_zero_crossing(), 0.25, 1e-15) << "twice: the first";
    EXPECT_EQ((Parabola{-1.0, 1.0, 1.0}).first_zero_crossing(), 0.0);
    EXPECT_TRUE(std::isinf((Parabola{1.0, 0.5, 1.0}).first_zero_crossing()));
}

TEST(BatteryStep, SolvesTheRcPairExactly) {
    const auto circuit = circuit_of(pack());
    const double length_s = 12.0;
    const RcStep step(circuit, length_s);
    // dU/dt = (R I - U) / tau with I = 2 + 3 s - s^2, s the part of the step, by ten thousand steps of midpoints.
    const auto current_a = [](double part) { return 2.0 + 3.0 * part - part * part; };
    double voltage_v = 0.1;
    constexpr int steps = 10000;
    for (int k = 0; k < steps; ++k) {
        const double h = length_s / steps;
        const auto rate = [&](double part, double v) {
            return (circuit.rc_resistance_ohm * current_a(part) - v) / circuit.rc_time_constant_s;
        };
        const double middle_v = voltage_v + h / 2.0 * rate(1.0 * k / steps, voltage_v);
        voltage_v += h * rate((k + 0.5) / steps, middle_v);
    }
    EXPECT_NEAR(0.1 * step.decay + step.of_first_ohm * current_a(0.0) + step.of_middle_ohm * current_a(0.5) +
                    step.of_last_ohm * current_a(1.0),
                voltage_v, 1e-9);
}

TEST(BatteryStep, FollowsTheOpenCircuitVoltage) {
    const auto battery = pack();
    VoltageLine line(battery.thevenin->open_circuit, 100.0);
    for (const double soc_percent : {100.0, 70.0, 40.0, 39.0, 5.0, 0.0, -3.0, 41.0, 100.5})
        EXPECT_NEAR(line(soc_percent), open_circuit_voltage_v(battery, std::clamp(soc_percent, 0.0, 100.0)), 1e-12)
            << soc_percent;
}

TEST(BatteryStep, TakesThePapersSourceAsOneVoltage) {
    const Battery paper{"paper", 11.1, 0.01, 3.0};
    EXPECT_EQ(open_circuit_of(paper).voltage_v, (std::vector<double>{11.1, 11.1}));
    EXPECT_EQ(circuit_of(paper).rc_resistance_ohm, 0.0);
    EXPECT_NEAR(circuit_of(paper).percent_per_as, 100.0 / (3.0 * 3600.0), 1e-15);
}

}  // namespace
}  // namespace flightwatt::battery
