#pragma once

#include "battery/battery.h"
#include "battery/discharge_record.h"

#include <optional>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// A record's voltage by a battery of other flights, from its current and the charge missing when it began.
struct ModelledRecord {
    const Battery* battery = nullptr;
    const DischargeRecord* record = nullptr;
    std::vector<double> soc_percent;    ///< at each sample
    std::vector<double> voltage_v;      ///< at each sample, without what the flight itself has shown
    double initial_charge_sd_ah = 0.0;  ///< of the charge missing when it began
    double warming_per_j = 0.0;         ///< of a CircuitFit
};

/// Returns the index behind the last sample under load: above 15 % of the highest current, where a flight begins.
std::size_t end_of_load(const DischargeRecord& record);

/// Returns the mean power [W] of records under load, up to 5, 10, 20, 40 ... s after their first load, each second
/// counting the same: take-offs draw more. Empty without any such second.
std::vector<double> load_power_course_w(std::span<const DischargeRecord* const> records);

/// A forecast is made so long after the first load, while the motors start.
inline constexpr double start_s = 3.0;

/// A flight's resistance relative to the battery's.
struct RelativeResistance {
    double value = 1.0;
    double half_width = 0.0;  ///< of the 95 % interval
};

/// Returns it by the first 3 s of load, about the scatter between flights.
RelativeResistance starting_resistance(const ModelledRecord& modelled);

/// Returns the voltage [V] at each sample as known `ahead_s` before it: offset, resistance and slope of the curve follow
/// the samples from the first load to then (docs/methods.md, Eq. 27c).
std::vector<double> predict_voltage_ahead(const ModelledRecord& modelled, double ahead_s);

/// Returns half the 95 % interval [V] of the voltage at each sample, as known while the motors start: of the initial
/// charge, the curve, and the resistance, which differs within a flight (docs/methods.md, Eq. 27d).
std::vector<double> voltage_half_widths_v(const ModelledRecord& modelled, const RelativeResistance& own);

/// Mean |error| [V] of the voltage of all that remains of a flight, of which nothing but the time of landing is known.
struct ForecastErrors {
    double before_v = 0.0;   ///< known while the motors start
    double updated_v = 0.0;  ///< known every 30 s of the flight, from 30 s on; the mean over these moments
};

/// Returns the errors of forecasts with the course of other flights' power, in flight times this flight's part of it so
/// far, of which they count as 30 s. None for a flight that is under load for less than a minute.
std::optional<ForecastErrors> forecast_errors(const ModelledRecord& modelled, const std::vector<double>& course_w);

}  // namespace flightwatt::battery
