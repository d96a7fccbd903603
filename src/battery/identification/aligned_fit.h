#pragma once

#include "battery/identification/circuit_problem.h"

#include <cstddef>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// Circuit and initial charges in one least squares (docs/methods.md): the charge missing at the start of each record
/// but the reference's is a parameter. Gauss-Newton steps start from where each record's voltage fits best on the curve
/// of the fuller ones. The curve has up to six equal segments of at least twenty samples each, and begins at charge 0.
/// Throws NoResultError where the voltage does not fall with charge drawn, or with current.
JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells);

/// The fit without some records (in ascending order; one or more remain), which starts from the fit of all.
JointCircuitFit fit_without(const JointCircuitFit& joint, std::span<const std::size_t> excluded);

/// Errors of the fit by the jackknife over blocks of time (docs/methods.md).
CircuitErrors circuit_errors(const JointCircuitFit& joint);

}  // namespace flightwatt::battery
