#include "mechanical/prediction/energy_estimate.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {

void add_share(EnergyEstimate& estimate, const VarianceShare& share) {
    estimate.variance_wh2 += share.variance_wh2;
    if (share.variance_wh2 > 0.0) {
        estimate.variance_square_per_degree_of_freedom +=
            share.variance_wh2 * share.variance_wh2 / share.degrees_of_freedom;
    }
}

EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b) {
    return {a.energy_wh + b.energy_wh, a.uncertainty_known && b.uncertainty_known,
            a.variance_wh2 + b.variance_wh2,
            a.variance_square_per_degree_of_freedom + b.variance_square_per_degree_of_freedom};
}

std::optional<EnergyInterval> interval_95(const EnergyEstimate& estimate) {
    if (!estimate.uncertainty_known) return std::nullopt;
    double half_wh = 0.0;
    if (estimate.variance_wh2 > 0.0) {
        const double degrees_of_freedom =
            estimate.variance_wh2 * estimate.variance_wh2 / estimate.variance_square_per_degree_of_freedom;
        half_wh = student_t_half_width(degrees_of_freedom) * std::sqrt(estimate.variance_wh2);
    }
    return EnergyInterval{std::max(estimate.energy_wh - half_wh, std::min(estimate.energy_wh, 0.0)),
                          estimate.energy_wh + half_wh};
}

}  // namespace flightwatt::mechanical
