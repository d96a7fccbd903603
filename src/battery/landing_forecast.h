#pragma once

#include "battery/battery.h"
#include "battery/discharge.h"
#include "battery/discharge_record.h"

#include <optional>
#include <span>

namespace flightwatt::battery {

/// A constant power for some time.
struct ConstantLoad {
    double power_w = 0.0;
    double duration_s = 0.0;
};

/// What a battery in flight must not go below.
struct LandingLimits {
    double cutoff_voltage_v = 0.0;     ///< 0: none
    double reserve_soc_percent = 0.0;  ///< what should be left
};

/// How a battery in flight will land.
struct LandingForecast {
    double soc_now_percent = 0.0;
    double soc_percent = 0.0;  ///< at the end of what lies ahead, or where the battery failed before
    double voltage_v = 0.0;    ///< there, under the last stretch's power
    double endurance_s = 0.0;  ///< so long could the cruise go on from there, down to the reserve
    bool keeps_reserve = true;
    std::optional<double> fails_after_s = {};  ///< from now: empty, cut off, or asked for more than it delivers
};

/// The state of charge at which the battery rests at a voltage, between 0 and 100 %. The battery is a Thévenin circuit.
double resting_soc_percent(const Battery& battery, double voltage_v);

/// The battery after what was flown: `initial_soc_percent` less the charge drawn since, with the voltage of the RC
/// pair. Throws NoResultError where more was drawn than there was.
BatteryState state_after(const Battery& battery, const DischargeRecord& flown, double initial_soc_percent);

/// Through a constant power from a state on; what ends the battery is told in seconds since then. Within 1e-3 points
/// and 1 mV of discharge(), at a tenth of its work.
Discharge discharge_constant_load(const Battery& battery, const BatteryState& from, const ConstantLoad& stretch,
                                  double cutoff_voltage_v);

/// From a state through the stretches ahead, at least one, in their order; `cruise_w` is the power that could go on.
LandingForecast forecast_landing(const Battery& battery, const BatteryState& now, std::span<const ConstantLoad> ahead,
                                 double cruise_w, const LandingLimits& limits = {});

}  // namespace flightwatt::battery
