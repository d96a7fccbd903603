#pragma once

#include "battery/battery.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

/// Batteries identified from flights.
namespace flightwatt::battery {

/// A warning about the number of cells, by the voltage of the fullest pack at rest: a cell outside the LiPo chart; or,
/// where the number was not given, full high-voltage cells (up to 4.45 V), one less. Empty without one.
std::string cells_warning(double resting_voltage_v, int cells, bool is_given);

/// Chemistry of a cell; each has a chart of its typical open-circuit voltage (chart_match.h).
enum class Chemistry { lipo, nmc, high_voltage };

std::string to_string(Chemistry chemistry);

/// Standard deviation of a cell from its chart: see chart_match.h.
inline constexpr double chart_sd_v = 0.08;

/// Origin of a capacity.
enum class CapacityOrigin {
    given,     ///< by the user
    measured,  ///< the flights drew nearly all of it
    chart      ///< from the part of the charts that the open-circuit voltage went down
};

std::string to_string(CapacityOrigin origin);

struct Capacity {
    double value_ah = 0.0;
    CapacityOrigin origin = CapacityOrigin::given;
    std::optional<Interval> interval_ah;  ///< 95 %; none of one that is given
};

/// Weight of the prior of a pack (circuit_problem.h) relative to the samples.
struct FitWeights {
    int cells = 3;
    double fullest_rest_v = 0.0;   ///< of all records
    double sample_error_v = 0.05;  ///< of one sample, as if samples were independent
};

/// A Thévenin circuit fitted to voltages: over charge drawn, because capacity is not needed for that.
struct CircuitFit {
    std::vector<double> knots_ah;        ///< rising, equally far apart
    std::vector<double> open_circuit_v;  ///< at the knots, straight lines between
    double resistance_ohm = 0.0;
    double rc_resistance_ohm = 0.0;   ///< 0: no RC pair found
    double rc_time_constant_s = 0.0;  ///< 0 without an RC pair
    double common_rest_offset_v = 0.0;
    double warming_per_j = 0.0;  ///< 0: none; the fall of ln R a joule of heat in it (docs/methods.md)
    FitWeights weights;
    double rms_v = 0.0;
};

/// 95 % intervals of a fitted circuit. A standard error is half the interval over 1.96.
struct CircuitErrors {
    Interval resistance_ohm;
    Interval rc_resistance_ohm;   ///< not below 0
    Interval rc_time_constant_s;  ///< symmetric in the logarithm
    std::vector<double> open_circuit_standard_error_v;
    Eigen::MatrixXd open_circuit_covariance_v2;   ///< of the knots
    std::vector<double> initial_charge_error_ah;  ///< of each record against the reference; standard error
};

/// The series resistance of one flight.
struct FlightResistance {
    double value_ohm = 0.0;
    double standard_error_ohm = 0.0;
    double degrees_of_freedom = 1.0;
    Interval interval_ohm;  ///< 95 %, not below 0
};

/// The standard deviation of resistances between flights, less their errors, with a prior of 15 % (packs within some 8
/// K) that counts as one further flight.
inline constexpr double default_scatter_fraction = 0.15;
double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm);

/// That with the number of resistances; std::nullopt for fewer than two.
std::optional<ResistanceScatter> resistance_scatter(std::span<const std::optional<FlightResistance>> resistances,
                                                    double fitted_ohm);

/// The charge of one flight for the same fall of the open-circuit voltage, relative to the mean flight.
struct FlightCapacity {
    double ratio = 1.0;       ///< of the pack's capacity in this flight to that of the mean flight
    Interval ratio_interval;  ///< 95 %
};

/// One flight in the fit.
struct IdentifiedFlight {
    std::string flight;
    double resting_voltage_v = 0.0;
    double initial_depletion_ah = 0.0;  ///< missing from the full pack when it began
    Interval initial_charge_interval_ah;
    double drawn_ah = 0.0;
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< with_capacities, where the flight determines it
    std::optional<double> air_temperature_c;
    std::optional<double> battery_temperature_c;  ///< mean
    std::optional<double> battery_start_c;        ///< at the first load
    std::size_t samples = 0;
    std::size_t unused = 0;  ///< samples with bursts at idle throttle
    double voltage_rms_v = 0.0;
};

/// Prediction of a flight's voltage by the others. Under load is from the first load on.
struct LeaveOneOutCheck {
    std::string flight;
    double voltage_rms_v = 0.0;      ///< of all samples, by their charge at rest and the first 3 s of load
    double load_rms_v = 0.0;         ///< of those under load, as known 3 s after the first load
    double load_mean_error_v = 0.0;  ///< mean |error| of those under load
    double load_half_width_v = 0.0;  ///< of the 95 % interval under load, mean
    double load_held_percent = 0.0;  ///< of those under load: within that interval
    double ahead_error_v = 0.0;      ///< mean |error|, predicted in flight 30 s before each sample
    /// Mean |error| of all that remains of the flight, by the others' power: known 3 s after the first load, or every 30 s
    /// in flight, with its power so far. None for a flight below a minute.
    std::optional<double> forecast_error_v = {};
    std::optional<double> updated_forecast_error_v = {};
    double initial_charge_ah = 0.0;     ///< missing from the full pack, by the others and its rest before take-off
    double extrapolated_percent = 0.0;  ///< of its samples: with more charge drawn than in any other flight
};

struct BatteryIdentification {
    Battery battery;
    CircuitFit fit;
    CircuitErrors errors;
    Capacity capacity;
    int cells = 0;
    bool cells_are_given = false;    ///< by the user or the logs
    std::string cells_warning = {};  ///< where the logs state other cells than their voltage at rest, or each other
    Chemistry chemistry = Chemistry::lipo;    ///< the most probable one
    double curve_start_depletion_ah = 0.0;    ///< from the full pack, where the curve begins
    double observed_min_soc_percent = 0.0;    ///< state of charge; below, the curve is the chart's
    double observed_max_soc_percent = 100.0;  ///< above, likewise
    std::vector<IdentifiedFlight> flights;
};

inline const IdentifiedFlight& fullest_flight(const BatteryIdentification& identified) {
    return *std::ranges::max_element(identified.flights, {}, &IdentifiedFlight::resting_voltage_v);
}

}  // namespace flightwatt::battery
