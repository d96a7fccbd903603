#include "battery/discharge_lanes.h"

#include "battery/fast_discharge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// A pack of three cells; none is like another.
Battery pack(int lane) {
    const double part = static_cast<double>(lane) / lane_count;
    Battery made{"pack", 0.0, 0.02 + 0.05 * part, 2.0 + part};
    made.thevenin = TheveninCircuit{{{0.0, 10.0, 40.0, 100.0}, {9.0 + part, 10.8, 11.4, 12.5}}, 0.03 * part, 30.0};
    return made;
}

double power_w(double time_s) { return 40.0 + 10.0 * std::sin(0.01 * time_s); }

struct Discharged {
    StateLanes state;
    int looked_at = 0;
};

/// From `soc_percent` on; what is looked at closer ends.
Discharged discharged(double soc_percent, double length_s, double cutoff_v) {
    auto batteries = make_lanes(pack(0));
    for (int lane = 0; lane < lane_count; ++lane) set_lane(batteries, lane, pack(lane));
    LoadLanes load{Lanes::Constant(length_s), static_cast<std::size_t>(length_s / 20.0), {}};
    load.power_w = [&](std::size_t half_step, Lanes& power) {
        power.setConstant(power_w(static_cast<double>(half_step) * 10.0));
    };
    Discharged result;
    result.state.is_active.set();
    result.state.soc_percent.setConstant(soc_percent);
    const auto look_closer = [&](int, std::size_t, BatteryState&) {
        ++result.looked_at;
        return false;
    };
    discharge_lanes(batteries, load, cutoff_v, look_closer, result.state);
    return result;
}

TEST(DischargeLanes, AreQuickDischargesSideBySide) {
    const auto [state, looked_at] = discharged(95.0, 1200.0, 9.0);
    EXPECT_EQ(looked_at, 0);
    for (int lane = 0; lane < lane_count; ++lane) {
        const auto alone = fast_discharge(pack(lane), {power_w, 0.0, 1200.0}, {95.0}, {20.0, 9.0});
        EXPECT_NEAR(state.soc_percent(lane), alone.soc_percent, 1e-9) << lane;
        EXPECT_NEAR(state.rc_voltage_v(lane), alone.rc_voltage_v, 1e-9) << lane;
    }
}

TEST(DischargeLanes, LookCloserAtWhatMayEnd) {
    for (const double cutoff_v : {0.0, 10.5}) {
        const auto [state, looked_at] = discharged(60.0, 1600.0, cutoff_v);
        int ended = 0;
        for (int lane = 0; lane < lane_count; ++lane) {
            const auto alone = fast_discharge(pack(lane), {power_w, 0.0, 1600.0}, {60.0}, {20.0, cutoff_v});
            const bool has_ended = alone.ended_at_s() || alone.undeliverable;
            EXPECT_NE(state.is_active[static_cast<std::size_t>(lane)], has_ended) << lane;
            ended += has_ended ? 1 : 0;
        }
        EXPECT_EQ(looked_at, ended) << "once each";
        EXPECT_GT(ended, 5);
    }
}

TEST(DischargeLanes, NeedTheveninCircuits) {
    EXPECT_THROW(make_lanes(Battery{"paper", 11.1, 0.01, 3.0}), std::invalid_argument);
}

}  // namespace
}  // namespace flightwatt::battery
