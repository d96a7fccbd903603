#include "mechanical/prediction/drift.h"

#include <cmath>

namespace flightwatt::mechanical {

double variance_of_mean_w2(const Drift& drift, double duration_s) {
    const double x = duration_s / drift.correlation_s;
    const double variance = drift.sd_w * drift.sd_w;
    // The closed form cancels for short stretches: 2 (x - 1 + exp(-x)) / x^2 = 1 - x/3 + ...
    if (x < 1e-4) return variance * (1.0 - x / 3.0);
    return variance * 2.0 * (x + std::expm1(-x)) / (x * x);
}

double covariance_of_means_w2(const Drift& drift, double first_s, double second_s) {
    const auto part = [&](double duration_s) {
        const double x = duration_s / drift.correlation_s;
        return x < 1e-12 ? 1.0 : -std::expm1(-x) / x;
    };
    return drift.sd_w * drift.sd_w * part(first_s) * part(second_s);
}

}  // namespace flightwatt::mechanical
