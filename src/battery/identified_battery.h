#pragma once

#include "battery/battery.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

/// What flights tell of the battery that they were flown on.
namespace flightwatt::battery {

/// What is doubtful of the number of cells, by the voltage of the fullest pack at rest: a cell below or above the LiPo
/// chart; or, where the number was not given, full high-voltage cells (up to 4.45 V), one less. Empty if nothing is.
std::string cells_warning(double resting_voltage_v, int cells, bool is_given);

/// What a cell is made of; each has a chart of its usual open-circuit voltage (chart_match.h).
enum class Chemistry { lipo, nmc, high_voltage };

std::string to_string(Chemistry chemistry);

/// How packs differ from their chart, a cell, as a standard deviation: see chart_match.h.
inline constexpr double chart_sd_v = 0.08;

/// Where a capacity comes from.
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

/// How much the prior of a pack (circuit_problem.h) counts beside the samples.
struct FitWeights {
    int cells = 3;
    double fullest_rest_v = 0.0;  ///< of all records
    /// Of one sample, as if samples were independent; the prior counts in proportion.
    double sample_error_v = 0.05;
};

/// A Thévenin circuit fitted to voltages: over charge drawn, because capacity is not needed for that.
struct CircuitFit {
    std::vector<double> knots_ah;        ///< rising, equally far apart
    std::vector<double> open_circuit_v;  ///< at the knots, straight lines between
    double resistance_ohm = 0.0;
    double rc_resistance_ohm = 0.0;   ///< 0: no RC pair explains anything
    double rc_time_constant_s = 0.0;  ///< 0 without an RC pair
    double common_rest_offset_v = 0.0;
    FitWeights weights;
    double rms_v = 0.0;
};

/// 95 % intervals of a fitted circuit. A standard error is half the interval over 1.96: what a normal distribution of
/// the same interval has.
struct CircuitErrors {
    Interval resistance_ohm;
    Interval rc_resistance_ohm;   ///< not below 0
    Interval rc_time_constant_s;  ///< symmetric in the logarithm
    std::vector<double> open_circuit_standard_error_v;
    Eigen::MatrixXd open_circuit_covariance_v2;   ///< of the knots
    std::vector<double> initial_charge_error_ah;  ///< of each record against the reference; standard error
    std::size_t blocks = 0;                       ///< of time, that the intervals rest on
    double block_s = 0.0;                         ///< their mean length
};

/// Why a record is taken to be flown on the pack of the one before it.
struct PackLink {
    std::size_t earlier = 0;
    double charge_ah = 0.0;          ///< drawn by the earlier one
    double error_ah = 0.0;           ///< of that: 2 % and 5 mAh, what the counter and the time after the log may hide
    double pause_s = 0.0;            ///< from the end of the earlier record
    bool counter_continues = false;  ///< the autopilot counted on: it was not without a pack in between
};

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

/// One flight in the fit.
struct IdentifiedFlight {
    std::string flight;
    double resting_voltage_v = 0.0;
    double initial_depletion_ah = 0.0;  ///< missing from the full pack when it began
    Interval initial_charge_interval_ah;
    double drawn_ah = 0.0;
    std::string same_pack_as;      ///< assumed to be flown on the pack that this flight left; empty: none is known
    std::optional<PackLink> link;  ///< why; `earlier` is its place among the flights
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< with_capacities, where the flight tells it
    std::optional<double> air_temperature_c;
    std::size_t samples = 0;
    std::size_t unused = 0;  ///< with a current that the motor did not draw
    double voltage_rms_v = 0.0;
};

/// How a flight's voltage is predicted by the others. Under load is from the first load on.
struct LeaveOneOutCheck {
    std::string flight;
    double voltage_rms_v = 0.0;      ///< of all samples, from what is known before take-off
    double load_rms_v = 0.0;         ///< of those under load
    double initial_charge_ah = 0.0;  ///< missing from the full pack, as the others and its rest before take-off tell it
    std::string pack_of;             ///< by which flight's pack; empty: by its resting voltage
    double best_offset_load_rms_v =
        0.0;                      ///< with the initial charge that fits its voltage best, which is known afterwards
    double best_offset_ah = 0.0;  ///< that initial charge
    double extrapolated_percent = 0.0;  ///< of its samples: with more charge drawn than in any other flight
};

struct BatteryIdentification {
    Battery battery;
    CircuitFit fit;
    CircuitErrors errors;
    Capacity capacity;
    int cells = 0;
    bool cells_are_given = false;
    Chemistry chemistry = Chemistry::lipo;    ///< the most probable one
    double curve_start_depletion_ah = 0.0;    ///< from the full pack, where the curve begins
    double observed_min_soc_percent = 0.0;    ///< state of charge; below, the curve is the chart's
    double observed_max_soc_percent = 100.0;  ///< above, likewise
    std::vector<IdentifiedFlight> flights;
    std::optional<ResistanceTrend> trend;  ///< over the flights in the order of their clocks, else as given
};

/// [V] of the fullest flight.
inline double highest_resting_v(const BatteryIdentification& identified) {
    return std::ranges::max(identified.flights, {}, &IdentifiedFlight::resting_voltage_v).resting_voltage_v;
}

}  // namespace flightwatt::battery
