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

/// Of each lane from `soc_percent` on, in steps that are longer from lane to lane, 10 to 20 s; what may end does.
struct Discharged {
    DischargeLanes lanes{pack(0)};
    LaneMask has_ended;
    int looked_at = 0;

    Discharged(double soc_percent, int steps, double cutoff_v) {
        Lanes step_s;
        for (int lane = 0; lane < lane_count; ++lane) {
            step_s(lane) = length_s(lane, 1);
            lanes.set_battery(lane, pack(lane));
            lanes.set_state(lane, {soc_percent});
            lanes.set_step(lane, step_s(lane));
        }
        const auto powers = [&](double k) -> Lanes { return (k * step_s).unaryExpr(&power_w); };
        for (int k = 0; k < steps; ++k) {
            const auto may_end = lanes.step(powers(k), powers(k + 0.5), powers(k + 1.0), cutoff_v) & ~has_ended;
            looked_at += static_cast<int>(may_end.count());
            has_ended |= may_end;
        }
    }

    static double length_s(int lane, int steps) { return steps * (10.0 + 10.0 * lane / (lane_count - 1)); }
};

TEST(DischargeLanes, AreQuickDischargesSideBySide) {
    const Discharged found(95.0, 60, 9.0);
    EXPECT_EQ(found.looked_at, 0);
    for (int lane = 0; lane < lane_count; ++lane) {
        const double length_s = Discharged::length_s(lane, 60);
        const auto alone = fast_discharge(pack(lane), {power_w, 0.0, length_s}, {95.0}, {length_s / 60.0, 9.0});
        EXPECT_NEAR(found.lanes.state(lane).soc_percent, alone.soc_percent, 1e-9) << lane;
        EXPECT_NEAR(found.lanes.state(lane).rc_voltage_v, alone.rc_voltage_v, 1e-9) << lane;
    }
}

TEST(DischargeLanes, NameWhatMayEnd) {
    for (const double cutoff_v : {0.0, 10.5}) {
        const Discharged found(60.0, 100, cutoff_v);
        int ended = 0;
        for (int lane = 0; lane < lane_count; ++lane) {
            const double length_s = Discharged::length_s(lane, 100);
            const auto alone =
                fast_discharge(pack(lane), {power_w, 0.0, length_s}, {60.0}, {length_s / 100.0, cutoff_v});
            const bool has_ended = alone.ended_at_s() || alone.undeliverable;
            EXPECT_EQ(found.has_ended[static_cast<std::size_t>(lane)], has_ended) << lane;
            ended += has_ended ? 1 : 0;
        }
        EXPECT_EQ(found.looked_at, ended) << "once each";
        EXPECT_GT(ended, 5);
    }
}

}  // namespace
}  // namespace flightwatt::battery
