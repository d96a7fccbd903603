#pragma once

#include "battery/discharge_record.h"
#include "battery/identified_battery.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// A record in the joint fit, with its own parameters.
struct AlignedRecord {
    const DischargeRecord* record = nullptr;
    double initial_charge_ah = 0.0;  ///< missing when it began, counted from where the curve begins
    double rest_offset_v = 0.0;      ///< height above the curve before its first load
    double resistance_ohm = 0.0;     ///< in series, when half of the record's heat has warmed the pack
    double log_capacity = 0.0;       ///< against the mean record; 0 but for the state of health
};

/// A circuit, and its records with their own parameters.
struct JointCircuitFit {
    std::vector<AlignedRecord> records;
    CircuitFit fit;
    std::size_t reference = 0;       ///< the record with the highest resting voltage, with which others are aligned
    Interval time_constants_s = {};  ///< range of an RC pair's that records can determine
};

/// Prior of a pack, as standard deviations. A resting voltage differs from the curve under load, because a pack relaxes
/// for an hour: by a common 50 mV a cell, and in each flight by charged_rest_sd_v a cell and lower_rest_fraction of the
/// difference to the fullest. The curve's slope changes by some 0.15 V a segment and cell. A cold pack that warms loses
/// 3 % of its resistance a kelvin, and takes 6 J a kelvin and Wh that it stores.
inline constexpr double common_rest_sd_v = 0.05;
inline constexpr double slope_change_sd_v = 0.15;
inline constexpr double warming_sd_wh_per_j = resistance_fall_per_k / 6.0;

/// Free parameters in addition to those in which the voltage is linear: the knots, the rest offsets, the RC resistance
/// and one series resistance. The initial charge of the reference is always fixed. With the time constant the warming
/// is free.
struct FreeParameters {
    bool initial_charges = true;
    bool time_constant = true;
    bool own_resistances = false;  ///< one a record
    bool own_capacities = false;
};
inline constexpr FreeParameters linear_only{false, false, false, false};

/// Parameters that all records have in common: the knots, and behind them these. The last is no parameter: it holds the
/// sum of the capacities' logarithms at 0 (a Lagrange multiplier).
enum CommonColumn : Eigen::Index {
    common_rest_column,
    resistance_column,
    rc_column,
    time_constant_column,  ///< its logarithm
    warming_column,
    capacity_sum_column,
    common_columns
};

/// Parameters of one record, behind the common ones in its equations.
enum OwnColumn : Eigen::Index { rest_column, charge_column, own_resistance_column, capacity_column, own_columns };

/// Sets the knots at equal distances over the charge of the records.
void place_knots(JointCircuitFit& joint, int segments);

/// Measured less fitted voltage of a record's used samples.
Eigen::VectorXd residual_v(const JointCircuitFit& joint, std::size_t record);

/// A part of the normal equations, in the columns of a record: the common parameters, then its own. Those that are
/// fixed have zeros.
struct Equations {
    Eigen::MatrixXd normal;
    Eigen::VectorXd pull;
};

struct RecordEquations {
    Equations sum;                  ///< of its blocks, with its prior
    std::vector<Equations> blocks;  ///< intervals of its time: 12, of a single record 30, of 15 s or longer
};

/// The normal equations of the least squares of voltages and prior at a fit: a block matrix in arrow form, because
/// records have only the common parameters in common.
struct NormalEquations {
    Equations circuit;  ///< the prior of the common parameters, without columns of a record
    std::vector<RecordEquations> records;
    double objective = 0.0;  ///< sum of squares [V^2]

    Eigen::Index common_count() const { return circuit.pull.size(); }
};
NormalEquations normal_equations(const JointCircuitFit& joint, const FreeParameters& free);

/// Changes of all parameters.
struct ParameterStep {
    Eigen::VectorXd common;
    Eigen::MatrixXd own;            ///< a column a record
    double objective_change = 0.0;  ///< by the linearisation, below 0 [V^2]
};

/// The Gauss-Newton step; the solution of a linear problem.
ParameterStep step_of(const NormalEquations& problem);

/// Gauss-Newton steps until they no longer improve; returns the equations at the end. After each step the knots are set
/// again, and the linear parameters are solved (variable projection: Golub and Pereyra 1973). An RC pair whose
/// resistance would be negative is dropped.
NormalEquations least_squares(JointCircuitFit& joint, const FreeParameters& free);

/// By the jackknife over blocks (CR3, linearised). Standard errors are not less than for independent samples of the
/// effective error, as of parameters that only the prior determines; 0 of fixed parameters.
struct ParameterErrors {
    Eigen::MatrixXd common_changes;  ///< a row a parameter: products of two rows are covariances
    Eigen::VectorXd common;
    Eigen::MatrixXd own;  ///< a column a record
    double degrees_of_freedom = 0.0;
};
ParameterErrors parameter_errors(const NormalEquations& problem, double sample_error_v);

/// Circuit and initial charges in one least squares (docs/methods.md): the charge missing at the start of each record
/// but the reference's is a parameter. Gauss-Newton steps start from where each record's voltage fits best on the curve
/// of the fuller ones. The curve has up to six equal segments of at least twenty samples each, and begins at charge 0.
/// Throws NoResultError where the voltage does not fall with charge drawn, or with current.
JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells);

/// The fit without some records (in ascending order; one or more remain), which starts from the fit of all.
JointCircuitFit fit_without(const JointCircuitFit& joint, std::span<const std::size_t> excluded);

/// Errors of the fit by the jackknife over blocks of time (docs/methods.md).
CircuitErrors circuit_errors(const JointCircuitFit& joint);

/// State of health of a pack by one flight.
struct FlightHealth {
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< only where it was asked for, and the flight determines it
    double initial_charge_error_ah = 0.0;    ///< standard error with a resistance of its own
};

/// Of each record, from the joint fit with a series resistance of each and, `with_capacity`, a factor on the charge
/// drawn (the mean of their logarithms is 0). Errors of capacities include 10 mV a cell over the voltage's fall. No
/// resistance with a standard error above half of it, no capacity with an interval of more than 15 % to either side.
std::vector<FlightHealth> estimate_state_of_health(JointCircuitFit joint, bool with_capacity);

}  // namespace flightwatt::battery
