#pragma once

#include "battery/battery.h"

#include <cstddef>
#include <optional>
#include <span>

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

}  // namespace flightwatt::battery
