#pragma once

#include <algorithm>

#include <boost/math/distributions/students_t.hpp>

namespace flightwatt::mechanical {

/// What every interval of ours is meant to hold.
inline constexpr double confidence_level = 0.95;

/// Half the width of a 95 % interval, in standard errors: Student's t of so many degrees of freedom (at least
/// one, whole or not).
inline double half_width_in_standard_errors(double degrees_of_freedom) {
    const boost::math::students_t distribution(std::max(1.0, degrees_of_freedom));
    return boost::math::quantile(distribution, 0.5 + confidence_level / 2.0);
}

}  // namespace flightwatt::mechanical
