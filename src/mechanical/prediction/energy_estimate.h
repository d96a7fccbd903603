#pragma once

#include <optional>

namespace flightwatt::mechanical {

/// An independent cause of uncertainty: its variance and the degrees of freedom that the variance rests on.
struct VarianceShare {
    double variance_wh2 = 0.0;
    double degrees_of_freedom = 0.0;
};

/// An energy that is predicted. Without `uncertainty_known` there is no interval: one flight alone does not
/// tell how flights differ.
struct EnergyEstimate {
    double energy_wh = 0.0;
    bool uncertainty_known = true;
    double variance_wh2 = 0.0;
    double variance_square_per_degree_of_freedom =
        0.0;  ///< sum over the shares of variance^2 / degrees_of_freedom
};

void add_share(EnergyEstimate& estimate, const VarianceShare& share);

/// Both together, as if they were independent.
EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b);

struct EnergyInterval {
    double low_wh = 0.0;
    double high_wh = 0.0;
    bool contains(double energy_wh) const { return low_wh <= energy_wh && energy_wh <= high_wh; }
};

/// 95 % predictive interval: Student's t with Welch and Satterthwaite's degrees of freedom. A low
/// end below 0 becomes 0: a drone takes no energy back. std::nullopt without known uncertainty.
std::optional<EnergyInterval> interval_95(const EnergyEstimate& estimate);

}  // namespace flightwatt::mechanical
