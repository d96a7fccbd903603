#pragma once

#include "mechanical/mechanical_model.h"

#include <span>
#include <vector>

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

struct StudentT {
    double scale = 0.0;
    double degrees_of_freedom = 0.0;
};

/// The Student's t about 0 that is nearest to a mixture of normal distributions about 0: it has the mixture's central
/// 68 and 95 %. `sds` and `weights` are equally long, the weights sum to 1. Of a mixture that is no wider in its tails
/// than a normal one, 200 degrees of freedom.
StudentT fit_student_t(std::span<const double> sds, std::span<const double> weights);

}  // namespace flightwatt::mechanical
