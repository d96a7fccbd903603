#pragma once

#include "battery/identification/circuit_problem.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// Circuit and initial charges in one least squares (docs/methods.md): the charge missing at the start of each record
/// but the reference's is a parameter. Gauss-Newton steps start from `begin_ah`, by default from where each record's
/// voltage fits best on the curve of the fuller ones. The curve has up to six equal segments of at least twenty samples
/// each, and begins at charge 0. Throws NoResultError where the voltage does not fall with charge drawn, or with
/// current.
JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells, PackLinks links = {},
                                    std::span<const double> begin_ah = {});

/// The minimum of a function between two values: by a grid, then by Brent's method around its lowest point.
double grid_minimum(const std::function<double(double)>& function, double low, double high);

/// The last flight of `known` on the pack of `later`: the last record before it that ended at most six hours earlier,
/// by the clocks of the logs or those in both names ("20_07_10__06_53_03"). None if a counter contradicts it, or if
/// `later` does not rest lower by half of the curve's fall, or by more than that fall and relaxation.
std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit);

/// Errors of the fit by the jackknife over blocks of time (docs/methods.md).
CircuitErrors circuit_errors(const JointCircuitFit& joint);

}  // namespace flightwatt::battery
