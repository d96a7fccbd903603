#pragma once

#include "battery/battery.h"
#include "battery/identification/discharge_record.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// A record and the charge [Ah] that was missing from the battery when it began.
struct AlignedRecord {
    const DischargeRecord* record = nullptr;
    double initial_charge_ah = 0.0;
};

/// A Thévenin circuit fitted to voltages: over charge drawn, because capacity is not needed for that.
struct CircuitFit {
    std::vector<double> knots_ah;        ///< rising
    std::vector<double> open_circuit_v;  ///< at the knots, straight lines between
    double resistance_ohm = 0.0;
    double rc_resistance_ohm = 0.0;   ///< 0: no RC pair explains anything
    double rc_time_constant_s = 0.0;  ///< 0 without an RC pair
    Eigen::VectorXd residual_v;       ///< measured less fitted; the used samples of the records, in their order
    double rms_v = 0.0;
};

/// The fit of least squares with these knots. Given the time constant all else is linear (variable projection: Golub
/// and Pereyra 1973), so that one alone is searched for: on a grid from two usual intervals to a quarter of the longest
/// record, then by Brent's method. Throws NoAnswerError where the records do not determine the curve or the resistance.
CircuitFit fit_circuit(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah);

/// Derivatives of the fitted voltages, one row a used sample: by the voltages at the knots, resistance,
/// rc_resistance and the logarithm of rc_time_constant; the last two columns are absent without an RC pair.
Eigen::MatrixXd voltage_derivatives(std::span<const AlignedRecord> records, const CircuitFit& fit);

/// 95 % intervals of a fitted circuit.
struct CircuitErrors {
    Interval resistance_ohm;
    Interval rc_resistance_ohm;   ///< not below 0
    Interval rc_time_constant_s;  ///< symmetric in the logarithm
    /// Half the knots' intervals over 1.96: what a normal distribution of the same interval has.
    std::vector<double> open_circuit_standard_error_v;
    std::size_t blocks = 0;  ///< of time, that the intervals rest on
    double block_s = 0.0;
};

/// By the jackknife over blocks of time, and from three records on over whole records too (docs/methods.md). Two errors
/// that residuals do not show come on top: rounding of a voltage that stands still, and how far a curve of twice the
/// segments moves the parameter.
CircuitErrors circuit_errors(std::span<const AlignedRecord> records, const CircuitFit& fit);

}  // namespace flightwatt::battery
