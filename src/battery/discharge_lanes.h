#pragma once

#include "battery/battery_step.h"
#include "battery/discharge.h"

#include <bitset>
#include <vector>

namespace flightwatt::battery {

using LaneMask = std::bitset<lane_count>;

/// The open-circuit voltages of lanes, whose charges mostly fall: each remembers the line that it is on. All have the
/// same knots.
class LaneVoltages {
  public:
    explicit LaneVoltages(const OpenCircuitVoltage& curve);
    void set_lane(int lane, const OpenCircuitVoltage& curve);
    Lanes operator()(const Lanes& soc_percent);

  private:
    void find_line(int lane, double soc_percent);

    std::vector<double> knots_percent_;
    std::vector<Lanes> knots_v_;  ///< one a knot
    Lanes low_percent_;
    Lanes high_percent_;
    Lanes offset_v_;
    Lanes slope_v_;
};

/// Batteries side by side, each from a state of its own, in steps of its own length, as fast_discharge() takes them.
class DischargeLanes {
  public:
    /// Room for batteries whose open-circuit voltages have the knots of this one.
    explicit DischargeLanes(const Battery& battery);
    DischargeLanes(const DischargeLanes&) = delete;
    DischargeLanes& operator=(const DischargeLanes&) = delete;

    /// A Thévenin circuit's.
    void set_battery(int lane, const Battery& battery);
    void set_state(int lane, const BatteryState& state);
    /// How long the lane's steps are from now on.
    void set_step(int lane, double length_s);

    /// One step of all, of powers that are never below 0; each starts where the last one ended, or where set_state put it.
    /// Returns the lanes whose battery may end within it: empty, below the cut-off voltage (0: never), or beyond the
    /// power limit.
    LaneMask step(const Lanes& start_w, const Lanes& middle_w, const Lanes& end_w, double cutoff_voltage_v);

    BatteryState state(int lane) const { return state_of(moments_[now_], lane); }
    /// As the last step began.
    BatteryState state_before(int lane) const { return state_of(moments_[1 - now_], lane); }

  private:
    static BatteryState state_of(const CircuitMoment<Lanes>& moment, int lane) {
        return {moment.soc_percent(lane), moment.rc_voltage_v(lane)};
    }

    Circuit<Lanes> circuit_;
    CircuitRun<Lanes, LaneVoltages> run_;
    StepLength<Lanes> length_;
    CircuitMoment<Lanes> moments_[2];  ///< the start and the end of the last step, in turn
    std::size_t now_ = 0;
    bool is_changed_ = true;  ///< by set_state: the step's start is not the end of the one before
    CircuitMoment<Lanes> middle_;
};

}  // namespace flightwatt::battery
