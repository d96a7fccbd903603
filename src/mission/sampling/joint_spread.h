#pragma once

#include "base/statistics.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mission {

/// The degrees of freedom of a known standard deviation: Student's t is then normal.
inline constexpr double infinite_dof = std::numeric_limits<double>::infinity();

/// Limit of drawn numbers of Student's t: with one degree of freedom, 6 of 10 million would be beyond.
inline constexpr double max_student = 1e6;

/// Returns the quantile of Student's t with the same tail probability as `normal` of a standard normal distribution.
double student_from_normal(double normal, double degrees_of_freedom);

/// Transforms standard normal numbers to numbers of the multivariate Student t with the identity as scale matrix: each,
/// and any weighted sum divided by the root of the sum of the squared weights, is Student t, and they are large
/// together, as all are in units of one estimated deviation. Each follows from those before it (docs/methods.md, Eq.
/// 31).
std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom);

/// Returns the 95 % interval of the fraction of new flights that is beyond a threshold, if a fraction between
/// `drawn.low` and `drawn.high` of the flights drawn by Student's t is beyond it: drawn flights average over all
/// standard deviations that few flights allow, and new flights have one of them (docs/methods.md, Eq. 31a).
Interval interval_of_share(const Interval& drawn, double degrees_of_freedom);

/// The spread of a quantity between flights, estimated from few flights.
struct EstimatedSpread {
    std::size_t quantity = 0;  ///< level_index() or duration_index() of a phase
    double sd = 0.0;           ///< standard deviation of a future flight
    double degrees_of_freedom = 1.0;
    std::vector<std::optional<double>> flight_values;  ///< the quantity in each of the model's flights
};

/// Quantities that are estimated from equally many flights, and are drawn together.
struct JointDistribution {
    double degrees_of_freedom = 1.0;
    std::vector<std::size_t> quantities;  ///< indices of the quantities, rising
    Eigen::MatrixXd factor;               ///< the quantities' deviations, in their order, are this times student_vector
};

/// Groups spreads of equal degrees of freedom, with the correlations in the flights for which all quantities of the
/// group are known. Quantities that are known for less than two flights are uncorrelated.
std::vector<JointDistribution> estimate_joint_distributions(const std::vector<EstimatedSpread>& spreads);

/// Returns whether a spread is known for enough flights to be correlated with others.
bool is_known_of_flights(const EstimatedSpread& spread);

}  // namespace flightwatt::mission
