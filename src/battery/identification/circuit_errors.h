#pragma once

#include "battery/battery.h"
#include "battery/identification/aligned_fit.h"
#include "battery/identified_battery.h"

#include <Eigen/Core>

namespace flightwatt::battery {

/// By the jackknife over blocks of time, initial charges among the parameters, and from three records on over whole
/// records too, initial charges held (docs/methods.md). Initial charges and knots have at least the error that they
/// would have if samples were independent, each with its effective error, and what is believed held. Errors that
/// residuals do not show come on top: rounding of a voltage that stands still, and how far a curve of twice the
/// segments moves the parameter.
CircuitErrors circuit_errors(const JointCircuitFit& aligned);

}  // namespace flightwatt::battery
