#pragma once

#include "battery/identification/circuit_problem.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::battery {

/// Circuit and initial charges in one least squares (docs/methods.md): the charge missing at the start of each record
/// but the reference's is a parameter. Gauss-Newton steps start from `begin_ah`; without them from where each record's
/// voltage is best on the curve of the fuller ones. The curve has as many equal segments as choose_segment_count says,
/// and begins at charge 0. Throws NoResultError where the voltage does not fall with charge drawn, or with current.
JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells, PackLinks links = {},
                                    std::span<const double> begin_ah = {});

/// Where a function is least between two places: by a grid, then by Brent's method beside its least point.
double grid_minimum(const std::function<double(double)>& function, double low, double high);

/// Which of `known` the pack of `later` was flown in last: the last record before it that ended at most six hours
/// earlier, by the clocks of the logs or those in both names ("20_07_10__06_53_03"). None if a counter contradicts it,
/// or if `later` does not rest lower by half of what the curve fell, or by more than that fall and relaxation.
std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit);

inline constexpr int max_segments = 12;

/// The lowest number of equal segments of the curve, of 1 to 12 and at least twenty samples each, that predicts
/// left-out parts as well as the best one, within one standard error (Hastie, Tibshirani and Friedman 2009, section
/// 7.10). A part is one record, or a block of a single one's time; its own level is free, initial charges and time
/// constant are held, and errors at rest do not count.
int choose_segment_count(const JointCircuitFit& joint);

/// Errors of the fit by the jackknife over blocks of time (docs/methods.md).
CircuitErrors circuit_errors(const JointCircuitFit& joint);

}  // namespace flightwatt::battery
