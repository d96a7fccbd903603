#pragma once

#include "battery/identification/circuit_fit.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// One a record: the earlier one whose pack it was flown on, if that is known.
using PackLinks = std::vector<std::optional<PackLink>>;

/// A circuit, and the initial charges that belong to it.
struct JointCircuitFit {
    std::vector<AlignedRecord> records;
    PackLinks links;
    CircuitFit fit;
    std::size_t reference = 0;  ///< the record with the highest resting voltage: others are aligned with it
};

/// Circuit and initial charges in one least squares (docs/methods.md): the charge missing at the start of each record
/// but the reference's is a parameter. Gauss-Newton steps start from `begin_ah`; without them from where each record's
/// voltage is best on the curve of the fuller ones. The curve has as many equal segments as rank_segment_counts says,
/// and begins at charge 0. Throws NoResultError where the voltage does not fall as charge is drawn.
JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells, PackLinks links = {},
                                    std::span<const double> begin_ah = {});

/// Which of `known` the pack of `later` was flown in last: the last record before it that ended at most six hours
/// earlier, by the clocks of the logs or those in both names ("20_07_10__06_53_03"). None if a counter contradicts it,
/// or if `later` does not rest lower by half of what the curve fell, or by more than that fall and relaxation.
std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit);

/// Numbers of equal segments of the curve, 1 to 12 and at least twenty samples each, in the order in which they are to
/// be tried: first the lowest number that predicts left-out parts as well as the best one, within one standard error
/// (Hastie, Tibshirani and Friedman 2009, section 7.10). A part is one record, or a twentieth of a single one; its own
/// level is free, initial charges and time constant are those of `fit`, and samples at rest do not count.
std::vector<int> rank_segment_counts(std::span<const AlignedRecord> records, const CircuitFit& fit);

/// Derivatives of one record's fitted voltages, one row a used sample, and the parameters that they are by: places in
/// the order of FitColumns, then of the records' initial charges (the reference's derivative is 0 throughout). By the
/// other records' parameters they are 0.
struct RecordJacobian {
    Eigen::Index first = 0;  ///< its first row among all used samples
    std::vector<Eigen::Index> parameter_indices;
    Eigen::MatrixXd columns;
};
std::vector<RecordJacobian> joint_jacobian(const JointCircuitFit& aligned);

/// By the jackknife over blocks of time, initial charges among the parameters, and from three records on over whole
/// records too, initial charges held (docs/methods.md). Initial charges and knots have at least the error that they
/// would have if samples were independent, each with its effective error, and what is believed held. Errors that
/// residuals do not show come on top: rounding of a voltage that stands still, and how far a curve of twice the
/// segments moves the parameter.
CircuitErrors circuit_errors(const JointCircuitFit& aligned);

/// Shared parameters and those of all records: FitColumns, then the initial charges.
Eigen::Index parameter_count(const JointCircuitFit& aligned);

/// What is believed and what the links say, as rows of all parameters, and what they leave.
struct JointPrior {
    Eigen::MatrixXd rows;
    Eigen::VectorXd residual;
};
JointPrior joint_prior(const JointCircuitFit& aligned);

/// The normal matrix of samples and of what is believed.
Eigen::MatrixXd normal_matrix(std::span<const RecordJacobian> records, const JointPrior& belief);

/// What the joint fit would change of its parameters: of a linear problem, all that is left to do.
Eigen::VectorXd gauss_newton_step(const JointCircuitFit& aligned);

/// Knots that part the charge of the records equally.
std::vector<double> uniform_knots(std::span<const AlignedRecord> records, int segments);

}  // namespace flightwatt::battery
