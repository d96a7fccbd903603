#include "mechanical/prediction/energy_estimate.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace flightwatt::mechanical {

void add_share(EnergyEstimate& estimate, const VarianceShare& share) {
    estimate.variance_wh2 += share.variance_wh2;
    if (share.variance_wh2 > 0.0) {
        estimate.variance_square_per_freedom += share.variance_wh2 * share.variance_wh2 / share.freedom;
    }
}

EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b) {
    return {a.energy_wh + b.energy_wh, a.uncertainty_known && b.uncertainty_known,
            a.variance_wh2 + b.variance_wh2, a.variance_square_per_freedom + b.variance_square_per_freedom};
}

double student_t_95(double freedom) {
    constexpr double upper = 0.975;
    return boost::math::quantile(boost::math::students_t_distribution<double>(freedom), upper);
}

std::optional<EnergyInterval> interval_95(const EnergyEstimate& estimate) {
    if (!estimate.uncertainty_known) return std::nullopt;
    double half_wh = 0.0;
    if (estimate.variance_wh2 > 0.0) {
        const double freedom =
            estimate.variance_wh2 * estimate.variance_wh2 / estimate.variance_square_per_freedom;
        half_wh = student_t_95(std::max(freedom, 1.0)) * std::sqrt(estimate.variance_wh2);
    }
    return EnergyInterval{std::max(estimate.energy_wh - half_wh, std::min(estimate.energy_wh, 0.0)),
                          estimate.energy_wh + half_wh};
}

}  // namespace flightwatt::mechanical
