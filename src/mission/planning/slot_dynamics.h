#pragma once

#include "battery/battery_step.h"
#include "mission/mission.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// Fast integration of state of charge and RC voltage over slots in which one choice runs, for the many schedules that
/// a search compares: power is tabulated, and steps are as long as its fastest harmonic and the RC pair permit. Within
/// 3e-6 points of `simulate` after a mission.
struct SlotDynamics {
    /// A part of a slot without a jump of power: the mechanical power at the starts, middles and ends of its
    /// steps, in each of which the current is a parabola.
    struct Part {
        double step_s;
        battery::StepLength step;
        std::vector<double> mechanical_w;  ///< 2 steps + 1
    };
    struct Slot {
        std::vector<Part> parts;  ///< several only along a path or a measured flight
        double min_mechanical_w = 0.0;
        double max_mechanical_w = 0.0;
        double duration_s = 0.0;
    };

    std::vector<Slot> slots;
    std::vector<double> compute_w;  ///< of each choice
    battery::Circuit circuit;
    battery::OpenCircuitVoltage open_circuit;
    double cutoff_voltage_v = 0.0;  ///< 0: never
};

/// Returns the dynamics of parts of a mission's phases, with the mechanical power times a factor.
SlotDynamics make_slot_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                                std::vector<double> compute_w, double mechanical_factor = 1.0);

/// Returns the battery at the end of a slot; none if it was cut off (by a parabola through the voltages at the start,
/// middle and end of each step), or could not deliver at the start or the end of a step. State of charge continues
/// below 0, and not above 100.
std::optional<battery::BatteryState> advance_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                  const battery::BatteryState& state);

/// Returns the battery after the slots from `from` to before `to`, in all of which one choice runs, as advance_slot.
std::optional<battery::BatteryState> advance_run(const SlotDynamics& dynamics, std::size_t from, std::size_t to,
                                                 std::size_t choice, const battery::BatteryState& state);

}  // namespace flightwatt::mission
