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

/// Limits of a battery in flight.
struct LandingLimits {
    double cutoff_voltage_v = 0.0;     ///< 0: none
    double reserve_soc_percent = 0.0;  ///< to be left at the landing
};

/// The battery at the landing.
struct LandingForecast {
    double soc_now_percent = 0.0;
    double soc_percent = 0.0;  ///< at the landing, or where the battery failed before
    double voltage_v = 0.0;    ///< there, under the last load
    double endurance_s = 0.0;  ///< of the cruise from there, down to the reserve
    bool keeps_reserve = true;
    std::optional<double> fails_after_s = {};  ///< from now: empty, cut off, or beyond the power limit
};

/// The state of charge at which the battery rests at a voltage, between 0 and 100 %. The battery is a Thévenin circuit.
double resting_soc_percent(const Battery& battery, double voltage_v);

/// Returns the standard deviation [points] of that state of charge, by those of the voltage at rest and of the curve.
double resting_soc_sd_percent(const Battery& battery, double voltage_v);

/// The battery after a record: `initial_soc_percent` less the charge drawn since, with the voltage of the RC pair.
/// Throws NoResultError where the record drew more.
BatteryState state_after(const Battery& battery, const DischargeRecord& flown, double initial_soc_percent);

/// The battery after a constant power, with times since its start. Within 1e-3 points and 1 mV of discharge(), and ten
/// times faster.
Discharge discharge_constant_load(const Battery& battery, const BatteryState& from, const ConstantLoad& load,
                                  double cutoff_voltage_v);

/// The landing after the loads ahead, at least one, in their order; `cruise_w` is the power that the endurance assumes.
LandingForecast forecast_landing(const Battery& battery, const BatteryState& now, std::span<const ConstantLoad> ahead,
                                 double cruise_w, const LandingLimits& limits = {});

}  // namespace flightwatt::battery
