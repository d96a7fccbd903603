#pragma once

#include <span>

namespace flightwatt::mechanical {

struct StudentT {
    double scale = 0.0;
    double degrees_of_freedom = 0.0;
};

/// The Student's t about 0 that is nearest to a mixture of normal distributions about 0: it has the mixture's central
/// 68 and 95 %. `sds` and `weights` are equally long, the weights sum to 1. Of a mixture that is no wider in its tails
/// than a normal one, 200 degrees of freedom.
StudentT fit_student_t(std::span<const double> sds, std::span<const double> weights);

}  // namespace flightwatt::mechanical
