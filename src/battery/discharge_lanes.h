#pragma once

#include "battery/battery_step.h"
#include "battery/discharge.h"

#include <array>
#include <bitset>
#include <cstddef>

namespace flightwatt::battery {

using LaneMask = std::bitset<lane_count>;

/// The open-circuit voltages of lanes; each lane's last line is cached. All curves have the same knots.
class LaneVoltages {
  public:
    explicit LaneVoltages(const OpenCircuitVoltage& curve);
    void set_lane(int lane, const OpenCircuitVoltage& curve);
    Lanes operator()(const Lanes& soc_percent);

  private:
    std::array<OpenCircuitVoltage, lane_count> curves_;
    Lanes low_percent_;
    Lanes high_percent_;
    Lanes offset_v_;
    Lanes slope_v_;
};

/// Batteries side by side, each with its own state and step length, in steps of fast_discharge().
class DischargeLanes {
  public:
    /// Room for batteries whose open-circuit voltages have the knots of this one.
    explicit DischargeLanes(const Battery& battery);
    DischargeLanes(const DischargeLanes&) = delete;
    DischargeLanes& operator=(const DischargeLanes&) = delete;

    /// The battery is a Thévenin circuit.
    void set_battery(int lane, const Battery& battery);
    void set_state(int lane, const BatteryState& state);
    /// Sets the length of the lane's next steps.
    void set_step(int lane, double length_s);

    /// One step of all lanes, with powers of 0 or more, from the end of the last step or from set_state's. Returns the
    /// lanes whose battery may end within it (end_margin).
    LaneMask step(const Lanes& start_w, const Lanes& middle_w, const Lanes& end_w, double cutoff_voltage_v);

    BatteryState state(int lane) const { return state_of(moments_[now_], lane); }
    /// At the start of the last step.
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
