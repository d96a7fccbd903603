#pragma once

#include "base/statistics.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mission {

/// Degrees of freedom of a known standard deviation: Student's t is then normal.
inline constexpr double infinite_dof = std::numeric_limits<double>::infinity();

/// No number of Student's t is drawn further out: with one degree of freedom, 6 of 10 million would be.
inline constexpr double max_student = 1e6;

/// The quantile of Student's t with the same tail probability as `normal` of a standard normal.
double student_from_normal(double normal, double degrees_of_freedom);

/// The standard normal numbers as numbers of the multivariate Student t with covariance structure 1: each is Student t,
/// so is any weighted sum of them (in the root of the squares' sum), and they are far out together, since all are in
/// units of one deviation that is estimated. One after the other, each given those before (docs/methods.md, Eq. 31).
std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom);

/// Returns the 95 % interval of the part of new flights that is beyond a threshold, where between `drawn.low` and
/// `drawn.high` of the flights drawn by Student's t are: drawn flights average over all spreads that few flights allow,
/// and new flights have one of them (docs/methods.md, Eq. 31a).
Interval interval_of_share(const Interval& drawn, double degrees_of_freedom);

/// How one of them differs, as few flights show.
struct EstimatedSpread {
    std::size_t quantity = 0;
    double sd = 0.0;  ///< of a flight to come
    double degrees_of_freedom = 1.0;
    std::vector<std::optional<double>> flight_values;  ///< the quantity itself in each of the model's flights
};

/// Quantities that rest on as many flights, and are drawn together.
struct JointDistribution {
    double degrees_of_freedom = 1.0;
    std::vector<std::size_t> quantities;  ///< rising
    Eigen::MatrixXd factor;               ///< the quantities' deviations, in their order, are this times student_vector
};

/// Spreads of as many degrees of freedom together, with the correlations that the flights show which have all that is
/// known of any. Quantities known of less than two flights are uncorrelated.
std::vector<JointDistribution> estimate_joint_distributions(const std::vector<EstimatedSpread>& spreads);

/// True of a spread that `spreads` draws by how it went together with the others of its flights.
bool is_known_of_flights(const EstimatedSpread& spread);

}  // namespace flightwatt::mission
