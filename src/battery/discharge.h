#pragma once

#include "battery/battery.h"

#include <functional>
#include <optional>

namespace flightwatt {

/// Power [W] that the load draws, smooth over the time that it is asked for, as a function of time [s].
using PowerOverTime = std::function<double(double time_s)>;

/// When a load asked for more than the battery can deliver, U^2 / (4 R).
struct Undeliverable {
    double time_s = 0.0;
    double power_w = 0.0;
    double limit_w = 0.0;
};

/// What a load leaves of the battery's charge. At most one of the two accidents holds; after it nothing was
/// integrated.
struct Discharge {
    double soc_percent = 0.0;
    std::optional<double> empty_at_s;  ///< when the state of charge reached 0
    std::optional<Undeliverable> undeliverable;
};

/// Integrates dSoC/dt = -I_int / Q_c (Eq. 8) from `from_s` to `to_s` with classic Runge-Kutta, in equal steps
/// of at most `max_step_s` that end exactly at `to_s`. So power may jump at the ends: integrate from jump to
/// jump. Stops at empty, and where the power goes beyond the limit; both times are found to 1e-10 s. The
/// state of charge does not go above 100 %: what would charge a full battery is lost. Throws
/// std::invalid_argument if the times or the step make no sense.
Discharge discharge(const Battery& battery, const PowerOverTime& power_w, double from_s, double to_s,
                    double soc_percent, double max_step_s);

}  // namespace flightwatt
