#pragma once

#include <limits>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// Degrees of freedom of a deviation that is known: its Student t is normal.
inline constexpr double infinite_dof = std::numeric_limits<double>::infinity();

/// No number of Student's t is drawn further out: with one degree of freedom, 6 of 10 million would be.
inline constexpr double max_student = 1e6;

/// The chance of a standard normal number beyond `deviations`.
double normal_tail_probability(double deviations);

/// The number of Student's t beyond which just as many lie as beyond `normal` of a standard normal.
double student_from_normal(double normal, double degrees_of_freedom);

/// The inverse of that.
double normal_from_student(double student, double degrees_of_freedom);

/// The standard normal numbers as numbers of the multivariate Student t with covariance structure 1: each is Student t,
/// so is any weighted sum of them (in the root of the squares' sum), and they are far out together, since all are in
/// units of one deviation that is estimated. One after the other, each given those before (docs/methods.md, Eq. 34).
std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom);

}  // namespace flightwatt::mission
