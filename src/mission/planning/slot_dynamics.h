#pragma once

#include "battery/battery_step.h"
#include "mission/mission.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// Fast integration of state of charge and RC voltage over slots in which one choice runs, for the many schedules that
/// a search compares: power is tabulated, and steps are as long as the accuracy permits. `simulate` is the reference.
struct SlotDynamics {
    /// A part of a slot without a jump of power: the mechanical power at the starts, middles and ends of its
    /// steps, in each of which the current is a parabola.
    struct Part {
        double step_s;
        battery::StepLength step;
        std::vector<double> mechanical_w;  ///< 2 steps + 1
    };
    struct Slot {
        std::vector<Part> parts;  ///< one, but on a path
        double min_mechanical_w = 0.0;
        double max_mechanical_w = 0.0;
        double mechanical_energy_j = 0.0;
        double duration_s = 0.0;
    };

    std::vector<Slot> slots;
    std::vector<double> compute_w;  ///< of each choice
    battery::Circuit circuit;
    battery::OpenCircuitVoltage open_circuit;
    double cutoff_voltage_v = 0.0;  ///< 0: never
    // Error bounds of long steps. A battery that fails by less than these is not ended.
    double error_percent = 0.0;
    double error_v = 0.0;
    /// Of a constant source without cut-off: what each choice takes in each slot, from any state; infinite: more than
    /// can be delivered.
    std::vector<std::vector<double>> depletion_percent;
};

/// Assumed error bounds for steps of choose_coarse_step_s.
constexpr double coarse_error_percent = 2e-4;
constexpr double coarse_error_v = 1e-4;

/// The dynamics of parts of a mission's phases, with the mechanical power times a factor. Steps are at most `step_s`.
SlotDynamics make_slot_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                                std::vector<double> compute_w, double step_s, double mechanical_factor = 1.0);

/// The longest step [s] whose halving moves the end of neither the schedule of least power nor that of most by 1e-7
/// points, of the steps tried: 4 s (or half the RC time constant), and halves of that down to 0.05 s.
double choose_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                     const std::vector<double>& compute_w);

/// A longer step, of at most 20 s and the RC time constant, for the many states that a search only compares: doubled
/// while the ends of both schedules move by less than a tenth of coarse_error_percent.
double choose_coarse_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                            const std::vector<double>& compute_w, double step_s);

/// The battery at the end of a slot; none if it was cut off (by a parabola through the voltages at the start,
/// middle and end of each step), or could not deliver at the start or the end of a step. State of charge continues
/// below 0, and not above 100.
std::optional<battery::BatteryState> advance_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                  const battery::BatteryState& state);

/// The same over the slots from `from` to before `to`, in all of which one choice runs.
std::optional<battery::BatteryState> advance_run(const SlotDynamics& dynamics, std::size_t from, std::size_t to,
                                                 std::size_t choice, const battery::BatteryState& state);

/// [V] at rest.
double open_circuit_voltage_v(const SlotDynamics& dynamics, double soc_percent);

}  // namespace flightwatt::mission
