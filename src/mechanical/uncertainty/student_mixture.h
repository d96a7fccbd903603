#pragma once

#include "mechanical/fit/frequency_posterior.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// Student's t distribution for one number of degrees of freedom, tabled: a mixture asks for it a million times.
class StudentCdf {
  public:
    explicit StudentCdf(double degrees_of_freedom);
    double operator()(double t) const;

  private:
    std::vector<double> upper_;  ///< at t = sinh(i * spacing)
};

/// Student distributions with their weights, which sum to 1.
struct StudentMixture {
    std::vector<double> weight;
    std::vector<double> location;
    std::vector<double> scale;
};

double mixture_mean(const StudentMixture& mixture);

/// Standard deviation; from 2 degrees of freedom on it is infinite, and counts as that of 3.
double mixture_sd(const StudentMixture& mixture, double degrees_of_freedom);

/// Where the mixture's distribution function is 2.5 % and 97.5 %.
Interval mixture_interval(const StudentMixture& mixture, const StudentCdf& cdf);

/// The weighted mean of the nodes' degrees of freedom, for which all are computed.
double degrees_of_freedom(std::span<const MeanCurveNode> nodes);

/// What the nodes say of a linear function of the coefficients which depends on theta: row(theta) c.
template <typename Row>
StudentMixture mixture_of(std::span<const MeanCurveNode> nodes, const Row& row) {
    StudentMixture mixture;
    for (const auto& node : nodes) {
        const Eigen::VectorXd at = row(node.theta_rad);
        mixture.weight.push_back(node.weight);
        mixture.location.push_back(at.dot(node.coefficients));
        mixture.scale.push_back(std::sqrt(std::max(0.0, at.dot(node.scale * at))));
    }
    return mixture;
}

}  // namespace flightwatt::mechanical
