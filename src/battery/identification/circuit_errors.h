#pragma once

#include "battery/battery.h"
#include "battery/identification/aligned_fit.h"

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

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
    double block_s = 0.0;
};

/// By the jackknife over blocks of time, initial charges among the parameters, and from three records on over whole
/// records too, initial charges held (docs/methods.md). Initial charges and knots have at least the error that they
/// would have if samples were independent, each with its effective error, and what is believed held. Errors that
/// residuals do not show come on top: rounding of a voltage that stands still, and how far a curve of twice the
/// segments moves the parameter.
CircuitErrors circuit_errors(const JointCircuitFit& aligned);

}  // namespace flightwatt::battery
