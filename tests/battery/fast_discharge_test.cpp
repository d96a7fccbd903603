#include "battery/discharge.h"

#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// A pack of three cells whose curve bends at random places.
Battery drawn_pack(std::mt19937_64& random) {
    Battery pack{"drawn", 0.0, uniform(random, 0.0, 0.15), uniform(random, 1.0, 6.0)};
    TheveninCircuit circuit{{{0.0, uniform(random, 3.0, 9.0), uniform(random, 20.0, 80.0), 100.0}, {}},
                            uniform(random, 0.0, 0.08),
                            std::exp(uniform(random, std::log(0.5), std::log(300.0)))};
    circuit.open_circuit.voltage_v = {uniform(random, 8.0, 9.9), 10.8, uniform(random, 11.0, 11.9), 12.5};
    pack.thevenin = circuit;
    return pack;
}

/// Constant, or with three harmonics; never below 0. `step_s`: what fast_discharge may take.
struct DrawnLoad {
    Load load;
    double step_s = 20.0;
};
DrawnLoad drawn_load(std::mt19937_64& random, double start_s, bool constant) {
    const double level_w = uniform(random, 5.0, 60.0);
    const double end_s = start_s + uniform(random, 1.0, 600.0);
    if (constant) return {{[=](double) { return level_w; }, start_s, end_s}};
    const double omega = uniform(random, 0.005, 0.3);
    const double part = uniform(random, 0.0, 0.3);
    const auto power_w = [=](double t) {
        return level_w * (1.0 + part * (std::sin(omega * t) + std::cos(2.0 * omega * t) + std::sin(3.0 * omega * t)));
    };
    return {{power_w, start_s, end_s}, 2.0 * 3.14159265 / (12.0 * 3.0 * omega)};
}

TEST(FastDischarge, ChangesNothingInNoTime) {
    std::mt19937_64 random(4712);
    const auto pack = drawn_pack(random);
    const BatteryState before{61.25, 0.125};
    const auto after = fast_discharge(pack, {[](double) { return 30.0; }, 12.0, 12.0}, before, {20.0, 9.0});
    EXPECT_EQ(after.soc_percent, before.soc_percent);
    EXPECT_EQ(after.rc_voltage_v, before.rc_voltage_v);
    EXPECT_FALSE(after.undeliverable);
    EXPECT_FALSE(after.ended_at_s());
}

TEST(FastDischarge, IsExactOverAnyShortTime) {
    std::mt19937_64 random(4713);
    const auto pack = drawn_pack(random);
    const BatteryState full{90.0, 0.2};
    for (const double length_s : {1e-300, 1e-15, 1e-9, 1e-4, 0.009, 0.011}) {
        const Load load{[](double) { return 30.0; }, 5.0, 5.0 + length_s};
        const auto end = fast_discharge(pack, load, full, {20.0, 0.0});
        EXPECT_NEAR(end.soc_percent, full.soc_percent, 1e-3) << length_s;
        EXPECT_NEAR(end.rc_voltage_v, full.rc_voltage_v, 1e-3) << length_s;
    }
}

TEST(FastDischarge, PartsNoStepForEver) {
    std::mt19937_64 random(4713);
    const auto pack = drawn_pack(random);
    const double length_s = 0.5 * (1.0 + 4e-13);  // longer than the steps in which an end is searched, but by rounding
    const auto after = fast_discharge(pack, {[](double) { return 30.0; }, 0.0, length_s}, {50.0, 0.0}, {20.0, 13.0});
    EXPECT_TRUE(after.ended_at_s()) << "below its cut-off from the start";
}

TEST(FastDischarge, IsTheExactOneWithinItsTolerance) {
    std::mt19937_64 random(4711);
    std::size_t ended = 0;
    for (int pack_number = 0; pack_number < 60; ++pack_number) {
        const auto pack = drawn_pack(random);
        const double cutoff_v = pack_number % 3 == 0 ? 0.0 : uniform(random, 8.0, 11.0);
        Discharge exact{{uniform(random, 30.0, 100.0)}};
        auto quick = exact;
        double time_s = 0.0;
        for (int segment = 0; segment < 12; ++segment) {
            const auto [load, step_s] = drawn_load(random, time_s, segment % 2 == 0);
            const auto from = exact;
            exact = discharge(pack, load, from, {0.05, cutoff_v});
            const auto alone = fast_discharge(pack, load, from, {step_s, cutoff_v});
            // A flight that only just touches a limit may pass it in one of the two.
            if (exact.ended_at_s().has_value() != alone.ended_at_s().has_value() ||
                exact.undeliverable.has_value() != alone.undeliverable.has_value()) {
                ADD_FAILURE() << "pack " << pack_number << ", segment " << segment << ": one of them ends";
                break;
            }
            if (exact.ended_at_s() || exact.undeliverable) {
                ++ended;
                const auto when = [](const Discharge& d) {
                    return d.undeliverable ? d.undeliverable->time_s : *d.ended_at_s();
                };
                EXPECT_EQ(exact.empty_at_s.has_value(), alone.empty_at_s.has_value()) << pack_number;
                EXPECT_EQ(exact.cut_off_at_s.has_value(), alone.cut_off_at_s.has_value()) << pack_number;
                // As long as the voltage takes for what charges may differ by.
                EXPECT_NEAR(when(alone), when(exact), 0.2) << pack_number;
                break;
            }
            EXPECT_NEAR(alone.soc_percent, exact.soc_percent, 1e-3) << pack_number << ", " << segment;
            EXPECT_NEAR(alone.rc_voltage_v, exact.rc_voltage_v, 1e-3) << pack_number << ", " << segment;
            quick = fast_discharge(pack, load, quick, {step_s, cutoff_v});
            if (quick.ended_at_s() || quick.undeliverable) break;
            EXPECT_NEAR(quick.soc_percent, exact.soc_percent, 5e-3) << pack_number << ", " << segment;
            time_s = load.end_s;
        }
    }
    EXPECT_GT(ended, 30U);
}

}  // namespace
}  // namespace flightwatt::battery
