#include "mission/sampling/student.h"

#include <algorithm>
#include <cmath>

#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace flightwatt::mission {
namespace {

constexpr double min_chance = 1e-300;

// In long doubles they would take three times as long.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, Policy>;
using Normal = boost::math::normal_distribution<double, Policy>;

/// The quantile of `to` beyond which lies what lies beyond `value` of `from`, by the chance of the nearer tail.
template <typename From, typename To>
double as_far_out(const From& from, const To& to, double value) {
    using boost::math::cdf;
    using boost::math::complement;
    using boost::math::quantile;
    const double beyond = std::max(min_chance, cdf(complement(from, std::abs(value))));
    return std::copysign(quantile(complement(to, beyond)), value);
}

}  // namespace

double normal_tail_probability(double deviations) {
    return 0.5 * std::erfc(deviations / boost::math::constants::root_two<double>());
}

double student_from_normal(double normal, double degrees_of_freedom) {
    if (normal == 0.0 || std::isinf(degrees_of_freedom)) return normal;
    const Student student(degrees_of_freedom);
    return std::clamp(as_far_out(Normal(), student, normal), -max_student, max_student);
}

double normal_from_student(double student, double degrees_of_freedom) {
    if (student == 0.0 || std::isinf(degrees_of_freedom)) return student;
    const Student from(degrees_of_freedom);
    return as_far_out(from, Normal(), student);
}

std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom) {
    std::vector<double> numbers;
    double square_sum = 0.0;
    double freedom = degrees_of_freedom;
    for (const double normal : normals) {
        const double scale = std::isinf(freedom) ? 1.0 : std::sqrt((degrees_of_freedom + square_sum) / freedom);
        numbers.push_back(scale * student_from_normal(normal, freedom));
        square_sum += numbers.back() * numbers.back();
        freedom += 1.0;
    }
    return numbers;
}

}  // namespace flightwatt::mission
