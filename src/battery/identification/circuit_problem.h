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
    double rest_offset_v = 0.0;      ///< before its first load: so much above the curve
    double resistance_ohm = 0.0;     ///< in series; of all records alike but for the state of health
    double log_capacity = 0.0;       ///< against the mean record; 0 but for the state of health
};

/// One a record: the earlier one whose pack it was flown on, if that is known.
using PackLinks = std::vector<std::optional<PackLink>>;

/// A circuit, and its records with what is their own.
struct JointCircuitFit {
    std::vector<AlignedRecord> records;
    PackLinks links;
    CircuitFit fit;
    std::size_t reference = 0;       ///< the record with the highest resting voltage: others are aligned with it
    Interval time_constants_s = {};  ///< of an RC pair, that records can show
};

/// Prior of a pack, as standard deviations. A resting voltage differs from the curve under load, because a pack goes on
/// relaxing for an hour: in all flights alike (50 mV a cell), and in each: 10 mV a cell of packs that come from the
/// charger, and 0.3 of what it rests lower than the fullest. The curve's slope jumps by some 0.15 V a segment and cell.
inline constexpr double common_rest_sd_v = 0.05;
inline constexpr double charged_rest_sd_v = 0.01;
inline constexpr double lower_rest_fraction = 0.3;
inline constexpr double slope_change_sd_v = 0.15;

/// What is free beside the parameters in which the voltage is linear: the knots, the rest offsets, the RC resistance
/// and one series resistance. The initial charge of the reference is always held.
struct FreeParameters {
    bool initial_charges = true;
    bool time_constant = true;
    bool own_resistances = false;  ///< one a record
    bool own_capacities = false;
};
inline constexpr FreeParameters linear_only{false, false, false, false};

/// Where parameters stand. Place 0 stands for all that are held: nothing moves it.
struct ParameterPlaces {
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

/// Moves the knots so that they part the charge of the records equally.
void place_knots(JointCircuitFit& joint, int segments);

/// One row a used sample of a record.
struct RecordRows {
    Eigen::MatrixXd columns;     ///< derivatives of the fitted voltage
    Eigen::VectorXd residual_v;  ///< measured less fitted
    Eigen::VectorXd charge_ah;   ///< where on the curve
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

/// The normal equations of the least squares of voltages and prior at a fit. Blocks are parts of the records' time: 12
/// a record, 30 of a single one, of 15 s or longer.
struct NormalEquations {
    ParameterPlaces places;
    std::vector<RowBlock> blocks;
    Eigen::MatrixXd normal;
    Eigen::VectorXd pull;
    double objective = 0.0;  ///< sum of squares [V^2]

    /// Of the columns of one record's rows.
    std::vector<Eigen::Index> columns_of(std::size_t record) const;
};
NormalEquations normal_equations(const JointCircuitFit& joint, const FreeParameters& free);

/// What these equations change of the parameters: of a linear problem, all that is left to do.
Eigen::VectorXd step_of(const NormalEquations& problem);

/// Gauss-Newton steps until they no longer help; the equations where they end. After each step the knots are placed
/// anew, and what is linear is solved (variable projection: Golub and Pereyra 1973). An RC pair whose resistance would
/// be negative is dropped.
NormalEquations least_squares(JointCircuitFit& joint, const FreeParameters& free);

/// The inverse of the normal matrix, 0 for what is held.
Eigen::MatrixXd inverse_of(const NormalEquations& problem);

/// By how much the parameters move if a block is left out.
Eigen::VectorXd change_without(const NormalEquations& problem, const Eigen::MatrixXd& inverse, const RowBlock& block);

/// By the jackknife over blocks (CR3, linearised).
struct ParameterErrors {
    Eigen::MatrixXd changes;  ///< a row a parameter: products of two rows are covariances
    /// Not less than if samples were independent, each with its effective error: so of a parameter that only the prior
    /// determines.
    Eigen::VectorXd standard_error;
};
ParameterErrors parameter_errors(const NormalEquations& problem, double sample_error_v);

}  // namespace flightwatt::battery
