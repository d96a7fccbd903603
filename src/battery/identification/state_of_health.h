#pragma once

#include "battery/battery.h"
#include "battery/identification/aligned_fit.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// The series resistance that one flight alone shows.
struct FlightResistance {
    double value_ohm = 0.0;
    double standard_error_ohm = 0.0;
    double degrees_of_freedom = 1.0;
    Interval interval_ohm;           ///< 95 %, not below 0
    double charge_ah_per_ohm = 0.0;  ///< how far an error of it moves the initial charge that its voltage tells
};

/// The standard deviation of resistances between flights: of what they differ by more than their errors say, and of 15
/// %, as packs differ within some 8 K, which counts as one further flight.
inline constexpr double default_scatter_fraction = 0.15;
double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm);

/// That with the number of resistances; none of fewer than two.
std::optional<ResistanceScatter> resistance_scatter(std::span<const std::optional<FlightResistance>> resistances,
                                                    double fitted_ohm);

/// How a pack's resistance goes on from flight to flight: a straight line through the flights' resistances, by least
/// squares, with Student's t of what is left.
struct ResistanceTrend {
    std::size_t flights = 0;
    double ohm_per_flight = 0.0;
    Interval interval_ohm_a_flight;  ///< 95 %
};

/// In the order given; none of fewer than three resistances.
std::optional<ResistanceTrend> resistance_trend(std::span<const std::optional<FlightResistance>> in_order);

/// How much more charge one flight needed than the mean flight for the same way down the curve of voltage.
struct FlightCapacity {
    double ratio = 1.0;       ///< of the pack's capacity in this flight to that of the mean flight
    Interval ratio_interval;  ///< 95 %
};

/// What one flight tells of the state of its pack.
struct FlightHealth {
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< only where it was asked for, and the flight tells it
};

/// Of each record, in one least squares with the curve, the RC resistance, the rests and the initial charges: a series
/// resistance of its own and, `with_capacity`, a factor of its own on the charge that it draws (the mean of their
/// logarithms is 0). All are free together: with the curve of a common resistance held, flights on aged packs would
/// seem less aged than they are, as that curve has bent to them. Errors by the jackknife over a dozen blocks of each
/// flight's time, and not less than if samples were independent; those of capacities also hold 10 mV a cell that no
/// curve follows, over what the flight's voltage falls by. No resistance where current or charge varies too little, no
/// capacity where its interval is wider than 15 % to either side: the flight draws too little.
std::vector<FlightHealth> estimate_state_of_health(const JointCircuitFit& aligned, bool with_capacity);

}  // namespace flightwatt::battery
