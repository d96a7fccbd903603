#pragma once

#include "battery/battery.h"

#include <functional>
#include <optional>

namespace flightwatt::battery {

/// What a battery feeds, from one jump of power to the next.
struct Load {
    std::function<double(double time_s)> power_w;  ///< smooth from start to end
    double start_s = 0.0;
    double end_s = 0.0;
};

/// When a load asked for more than the battery can deliver, U^2 / (4 R).
struct Undeliverable {
    double time_s = 0.0;
    double power_w = 0.0;
    double limit_w = 0.0;
};

/// How a discharge is integrated, and where it ends.
struct DischargeOptions {
    double max_step_s = 0.1;
    double cutoff_voltage_v = 0.0;  ///< the load is switched off below it; 0: never
};

/// The battery after a load. Integration stops at the first of: empty, cut-off voltage, power limit; at most one of
/// these is set.
struct Discharge : BatteryState {
    std::optional<double> empty_at_s = std::nullopt;    ///< when the state of charge reached 0
    std::optional<double> cut_off_at_s = std::nullopt;  ///< when the voltage fell below the cut-off
    std::optional<Undeliverable> undeliverable = std::nullopt;

    /// When the battery ended, empty or cut off.
    std::optional<double> ended_at_s() const { return empty_at_s ? empty_at_s : cut_off_at_s; }
};

/// Integrates dSoC/dt = -I_int / Q_c (Eq. 8), and in a Thévenin circuit dU_rc/dt = (R_rc I_int - U_rc) / tau, with
/// classic Runge-Kutta, in equal steps of at most `max_step_s` (and half the time constant) that end exactly with
/// the load. Stops at empty, at cut-off, and where the power goes beyond the limit; the times are found to
/// 1e-10 s. The state of charge does not go above 100 %: what would charge a full battery is lost. Throws
/// std::invalid_argument if the times, the state or the options make no sense.
Discharge discharge(const Battery& battery, const Load& load, const BatteryState& state,
                    const DischargeOptions& options = {});

}  // namespace flightwatt::battery
