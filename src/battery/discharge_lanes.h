#pragma once

#include "battery/battery_step.h"

#include <bitset>
#include <cstddef>
#include <functional>
#include <vector>

namespace flightwatt::battery {

using LaneMask = std::bitset<lane_count>;

/// Thévenin circuits side by side; their curves have the same knots.
struct BatteryLanes {
    Circuit<Lanes> circuit;
    std::vector<double> knots_percent;
    std::vector<Lanes> knots_v;  ///< one a knot
};

/// No circuits yet, but room for those of `battery`. Throws std::invalid_argument if that is none of Thévenin's.
BatteryLanes make_lanes(const Battery& battery);
void set_lane(BatteryLanes& lanes, int lane, const Battery& battery);

struct StateLanes {
    Lanes soc_percent = Lanes::Constant(100.0);
    Lanes rc_voltage_v = Lanes::Zero();
    LaneMask is_active;  ///< the others have ended, or are empty lanes
};

/// What the batteries feed: loads that never charge, each in as many steps as the others.
struct LoadLanes {
    Lanes length_s = Lanes::Zero();
    std::size_t steps = 1;
    /// At half step 0, 1, ... to twice the steps; called once each, in order.
    std::function<void(std::size_t half_step, Lanes& power_w)> power_w;
};

/// Looks closer at a step that may end a lane's battery: from the state at its start to that at its end, or false if it
/// ended.
using StepResolver = std::function<bool(int lane, std::size_t step, BatteryState& state)>;

/// As fast_discharge() with these steps, of all lanes at once. Lanes that may reach what ends a battery are passed to
/// `resolve_step`: empty, below the cut-off voltage (0: never), beyond the power limit.
void discharge_lanes(const BatteryLanes& batteries, const LoadLanes& load, double cutoff_voltage_v,
                     const StepResolver& resolve_step, StateLanes& state);

}  // namespace flightwatt::battery
