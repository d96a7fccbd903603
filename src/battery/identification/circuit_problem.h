#pragma once

#include "battery/discharge_record.h"
#include "battery/identified_battery.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// A record in the joint fit, with its own parameters.
struct AlignedRecord {
    const DischargeRecord* record = nullptr;
    double initial_charge_ah = 0.0;  ///< missing when it began, counted from where the curve begins
    double rest_offset_v = 0.0;      ///< height above the curve before its first load
    double resistance_ohm = 0.0;     ///< in series; common to all records but for the state of health
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
/// for an hour: by a common 50 mV a cell, and in each flight by 10 mV a cell after charging and 0.3 of the difference
/// to the fullest. The curve's slope changes by some 0.15 V a segment and cell.
inline constexpr double common_rest_sd_v = 0.05;
inline constexpr double charged_rest_sd_v = 0.01;
inline constexpr double lower_rest_fraction = 0.3;
inline constexpr double slope_change_sd_v = 0.15;

/// Free parameters in addition to those in which the voltage is linear: the knots, the rest offsets, the RC resistance
/// and one series resistance. The initial charge of the reference is always fixed.
struct FreeParameters {
    bool initial_charges = true;
    bool time_constant = true;
    bool own_resistances = false;  ///< one a record
    bool own_capacities = false;
};
inline constexpr FreeParameters linear_only{false, false, false, false};

/// Indices of the parameters. Index 0 is that of all fixed ones.
struct ParameterIndices {
    struct Own {
        Eigen::Index rest = 0;
        Eigen::Index initial_charge = 0;
        Eigen::Index resistance = 0;
        Eigen::Index log_capacity = 0;
    };
    Eigen::Index first_knot = 1;
    Eigen::Index knots = 0;
    Eigen::Index common_rest = 0;
    Eigen::Index resistance = 0;  ///< the common one
    Eigen::Index rc_resistance = 0;
    Eigen::Index log_time_constant = 0;
    std::vector<Own> own;  ///< of each record
    Eigen::Index count = 0;
};

/// The derivatives of one record's voltage have a column a knot, and behind them these.
enum OwnColumn { rc_column, time_constant_column, rest_column, charge_column, resistance_column, capacity_column };
inline constexpr Eigen::Index own_columns = 6;

/// Sets the knots at equal distances over the charge of the records.
void place_knots(JointCircuitFit& joint, int segments);

/// One row a used sample of a record.
struct RecordRows {
    Eigen::MatrixXd columns;     ///< derivatives of the fitted voltage
    Eigen::VectorXd residual_v;  ///< measured less fitted
    Eigen::VectorXd charge_ah;   ///< position on the curve
};
RecordRows rows_of(const JointCircuitFit& joint, std::size_t record, const FreeParameters& free);

/// Consecutive rows of a record, and their part of the normal equations in the record's columns.
struct RowBlock {
    std::size_t record = 0;
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::MatrixXd normal;
    Eigen::VectorXd score;
};

/// The normal equations of the least squares of voltages and prior at a fit. Blocks are intervals of the records' time:
/// 12 of each record, 30 of a single one, of 15 s or longer.
struct NormalEquations {
    ParameterIndices places;
    std::vector<RowBlock> blocks;
    Eigen::MatrixXd normal;
    Eigen::VectorXd pull;
    double objective = 0.0;  ///< sum of squares [V^2]

    /// Of the columns of one record's rows.
    std::vector<Eigen::Index> columns_of(std::size_t record) const;
};
NormalEquations normal_equations(const JointCircuitFit& joint, const FreeParameters& free);

/// The Gauss-Newton step; the solution of a linear problem.
Eigen::VectorXd step_of(const NormalEquations& problem);

/// Gauss-Newton steps until they no longer improve; returns the equations at the end. After each step the knots are set
/// again, and the linear parameters are solved (variable projection: Golub and Pereyra 1973). An RC pair whose
/// resistance would be negative is dropped.
NormalEquations least_squares(JointCircuitFit& joint, const FreeParameters& free);

/// By the jackknife over blocks (CR3, linearised).
struct ParameterErrors {
    Eigen::MatrixXd changes;  ///< a row a parameter: products of two rows are covariances
    /// Not less than for independent samples of the effective error, as of parameters that only the prior determines.
    Eigen::VectorXd standard_error;
};
ParameterErrors parameter_errors(const NormalEquations& problem, double sample_error_v);

}  // namespace flightwatt::battery
