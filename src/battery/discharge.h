#pragma once

#include "battery/battery.h"

#include <functional>
#include <optional>

namespace flightwatt::battery {

/// Power drawn from a battery over one time interval without jumps.
struct Load {
    std::function<double(double time_s)> power_w;
    double start_s = 0.0;
    double end_s = 0.0;
};

/// The first time at which a load exceeded the power limit, U^2 / (4 R).
struct Undeliverable {
    double time_s = 0.0;
    double power_w = 0.0;
    double limit_w = 0.0;
};

/// Step of the integration, and cut-off voltage.
struct DischargeOptions {
    double max_step_s = 0.1;
    double cutoff_voltage_v = 0.0;  ///< the load is switched off below it; 0: never
};

/// The battery after a load. Integration stops at the first of: power limit, empty, cut-off voltage; at most one of
/// these is set.
struct Discharge : BatteryState {
    std::optional<double> empty_at_s = std::nullopt;    ///< when the state of charge reached 0
    std::optional<double> cut_off_at_s = std::nullopt;  ///< when the voltage fell below the cut-off
    std::optional<Undeliverable> undeliverable = std::nullopt;

    /// When the battery ended, empty or cut off.
    std::optional<double> ended_at_s() const { return empty_at_s ? empty_at_s : cut_off_at_s; }
    /// When the battery could not supply the load any more, for whichever reason.
    std::optional<double> failed_at_s() const {
        return undeliverable ? std::optional(undeliverable->time_s) : ended_at_s();
    }
};

/// Integrates dSoC/dt = -I_int / Q_c (Eq. 8), and in a Thévenin circuit dU_rc/dt = (R_rc I_int - U_rc) / tau, with
/// classic Runge-Kutta in equal steps of at most `max_step_s` and half the time constant. Its end is checked at the
/// start and after each step, and located to 1e-10 s. Charge beyond 100 % is lost. Throws std::invalid_argument for a
/// negative duration or voltage, a step that is not positive, or more than 100 %.
Discharge discharge(const Battery& battery, const Load& load, const BatteryState& state,
                    const DischargeOptions& options = {});

/// The longest step of fast_discharge, and where the battery ends.
struct FastDischargeOptions {
    double max_s = 20.0;  ///< over which the load's power is nearly a parabola
    double cutoff_voltage_v = 0.0;
};

/// As discharge(), for a Thévenin circuit under a load that never charges, some hundred times faster (CircuitRun);
/// steps in which the battery may end are discharge()'s. Within 1e-3 points and 1 mV of discharge() where the power is
/// constant, or a step a twelfth of its fastest harmonic. Throws std::invalid_argument if the circuit is not
/// Thévenin's, or as discharge().
Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& options);

}  // namespace flightwatt::battery
