#pragma once

#include "base/statistics.h"
#include "flight/flight_data.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::battery {

inline constexpr double max_capacity_ah = 200.0;  ///< of a pack; a number above is one in mAh
inline constexpr auto capacity_hint = "the unit is Ah: 5000 mAh is 5 Ah";

/// The limits of an RC pair's time constant: a faster pair is part of the series resistance.
inline constexpr double min_time_constant_s = 0.1;
inline constexpr double max_time_constant_s = 1e5;

/// Open-circuit voltage over state of charge: straight lines between knots.
struct OpenCircuitVoltage {
    std::vector<double> soc_percent;  ///< from 0 to 100, rising strictly
    std::vector<double> voltage_v;    ///< positive, never falling
};

/// The source of a Thévenin circuit.
struct TheveninCircuit {
    OpenCircuitVoltage open_circuit;
    double rc_resistance_ohm = 0.0;   ///< 0: no RC pair
    double rc_time_constant_s = 1.0;  ///< without an RC pair not used
};

/// Variability of the series resistance between flights of one pack, by temperature, rest and age. A new flight's is a
/// Student's t with as many degrees of freedom as flights, as the prior counts as one more (resistance_scatter_ohm).
struct ResistanceScatter {
    double sd_ohm = 0.0;
    std::size_t flights = 0;  ///< two or more
    bool operator==(const ResistanceScatter&) const = default;
};

/// Uncertainty of the parameters, each where the file has it.
struct BatteryIntervals {
    std::optional<Interval> capacity_ah;
    std::optional<Interval> voltage_v;       ///< of the paper's source
    std::optional<Interval> resistance_ohm;  ///< of the mean of the flights
    std::optional<ResistanceScatter> resistance_scatter;
    std::optional<Interval> rc_resistance_ohm;
    std::optional<Interval> rc_time_constant_s;
    std::vector<double> open_circuit_standard_error_v;  ///< one a knot of the curve, or empty
};

/// The capacity that the flights of an identified pack indicate, whatever capacity was given.
struct FlightEstimate {
    double capacity_ah = 0.0;
    Interval capacity_interval_ah;  ///< 95 %
    std::vector<std::string> flights = {};
    OpenCircuitVoltage open_circuit = {};  ///< over that capacity; without knots: the battery's own
};

/// A battery as an equivalent circuit behind a series resistor: an ideal source (Eqs. 8-10 of the paper), or
/// Thévenin's, whose source follows the state of charge and has an RC pair in series.
struct Battery {
    std::string name;
    double voltage_v = 0.0;                                  ///< U_int, of the paper's source; 0 in a Thévenin circuit
    double resistance_ohm = 0.0;                             ///< R_int, in series; 0 is an ideal source
    double capacity_ah = 0.0;                                ///< Q_c
    std::optional<TheveninCircuit> thevenin = std::nullopt;  ///< none: the paper's
    BatteryIntervals intervals = {};
    std::optional<int> cells = std::nullopt;                          ///< in series
    std::shared_ptr<const FlightEstimate> flight_estimate = nullptr;  ///< of a Thévenin circuit; drawn flights share it
    std::vector<flight::MonitorShare> monitors = {};  ///< of packs in parallel; empty: the first counts all
};

/// The battery monitors of flights, each with its mean part of the charge; the parts are unknown where flights differ by
/// more than 5 points, or have other monitors. Empty where the first monitor counts all.
std::vector<flight::MonitorShare> common_monitors(const std::vector<std::vector<flight::MonitorShare>>& flights);

/// Standard deviations of the voltage of a pack at rest, as packs relax for an hour: 10 mV a cell after charging, and
/// 0.3 of the fall below the full one.
inline constexpr double charged_rest_sd_v = 0.01;
inline constexpr double lower_rest_fraction = 0.3;

/// The fall of ln R a kelvin as a lithium pack warms: 0.015 to 0.045.
inline constexpr double resistance_fall_per_k = 0.03;

/// The state of a battery.
struct BatteryState {
    double soc_percent = 100.0;
    double rc_voltage_v = 0.0;  ///< across the RC pair; 0 at rest
};

/// "packs: the charge is that of all together, of which battery monitor 1 counts 55.0 % and ..."; empty where the first
/// monitor counts all.
std::string describe_monitors(const Battery& battery);

/// [Wh] of a full battery at rest: capacity times the mean of the open-circuit voltage over its charge.
double full_energy_wh(const Battery& battery);

/// [V] at rest.
double open_circuit_voltage_v(const Battery& battery, double soc_percent);

/// [ohm] in series after so much heat of the current in one ohm [J], as the pack warms; 1/R rises with the heat.
double warmed_resistance_ohm(const Battery& battery, double warming_per_j, double heat_a2s);

/// Returns the battery under a settled load: its RC pair is a resistance in series.
Battery settled(Battery battery);

/// [V] at the load that draws `current_a`.
double terminal_voltage_v(const Battery& battery, const BatteryState& state, double current_a);

/// The maximum power of a load, U^2 / (4 R) [W] with U before the resistor; infinite without resistance, 0 without
/// voltage.
double power_limit_w(const Battery& battery, const BatteryState& state = {});

/// I_int [A] while the load draws `power_w` (Eq. 10): the smaller root of R I^2 - U I + P = 0, in a form that
/// is exact for R = 0. Negative power charges: the current is then negative. Throws NoResultError if the
/// power is above the limit.
double internal_current_a(const Battery& battery, double power_w, const BatteryState& state = {});

/// The same for the power or the limit, whichever is less.
double limited_current_a(const Battery& battery, double power_w, const BatteryState& state = {});

/// The battery with the capacity and the curve that its flights indicate, where its own capacity is outside of their
/// 95 % interval; else none.
std::optional<Battery> estimated_by_flights(const Battery& battery);

/// "the capacity of 5 Ah contradicts the flights, which indicate ..."; empty where estimated_by_flights has none.
std::string capacity_warning(const Battery& battery);

/// Implausible values, a line each: a full voltage of less than 2.5 V or of more than 14 LiPo cells (60 V), a capacity
/// of less than 0.05 Ah, a power limit below 1 W; and capacity_warning.
std::vector<std::string> battery_warnings(const Battery& battery);

}  // namespace flightwatt::battery
