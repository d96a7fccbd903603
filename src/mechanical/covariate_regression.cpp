#include "mechanical/covariate_regression.h"

#include "base/statistics.h"
#include "mechanical/fit/phase_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flightwatt::mechanical {
namespace {

/// The flights' values of a covariate and their mean powers.
struct Points {
    std::vector<double> covariate;
    std::vector<double> power_w;
};

Points points_of(std::span<const PhaseSamples> flights, Covariate covariate) {
    Points points;
    for (const auto& flight : flights) {
        const auto& value =
            is_through_origin(covariate) ? flight.airspeed_cubed_m3_per_s3 : flight.covariates[covariate];
        if (!value || (is_through_origin(covariate) && *value <= 0.0)) continue;
        points.covariate.push_back(*value);
        points.power_w.push_back(mean_power_w(flight));
    }
    return points;
}

/// Each flight's own coefficient counts the same.
void fit_through_origin(CovariateRegression& law, const Points& points) {
    std::vector<double> coefficients;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        coefficients.push_back(points.power_w[i] / points.covariate[i]);
    }
    law.mean_power_w = mean(coefficients) * law.mean;
    law.slope_w = mean(coefficients) * law.sd;
    law.residual_sd_w = sample_sd(coefficients) * law.mean;
}

void fit_line(CovariateRegression& law, const Points& points) {
    const auto flights = static_cast<double>(law.flights);
    double product_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        product_sum += (points.covariate[i] - law.mean) / law.sd * (points.power_w[i] - law.mean_power_w);
    }
    law.slope_w = product_sum / flights;
    if (law.flights < min_regression_flights(law.covariate)) return;
    double residual_square_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        const double fitted_w = law.mean_power_w + law.slope_w * (points.covariate[i] - law.mean) / law.sd;
        residual_square_sum += std::pow(points.power_w[i] - fitted_w, 2);
    }
    law.residual_sd_w = std::sqrt(residual_square_sum / (flights - 2.0));
}

}  // namespace

std::optional<CovariateRegression> fit_covariate_regression(std::span<const PhaseSamples> flights,
                                                            Covariate covariate) {
    const auto points = points_of(flights, covariate);
    if (points.covariate.size() < 2 || !(sample_sd(points.covariate) > 0.0)) return std::nullopt;
    const auto [least, most] = std::ranges::minmax(points.covariate);
    CovariateRegression law{covariate,
                            points.covariate.size(),
                            mean(points.covariate),
                            sample_sd(points.covariate),
                            least,
                            most,
                            mean(points.power_w),
                            0.0,
                            {}};
    if (!is_through_origin(covariate)) {
        fit_line(law, points);
        return law;
    }
    fit_through_origin(law, points);
    if (!(law.mean_power_w > 0.0)) return std::nullopt;
    return law;
}

RegressionPrediction predict_mean_power(const CovariateRegression& law, double value) {
    const auto flights = static_cast<double>(law.flights);
    RegressionPrediction level;
    level.within_flights = value >= law.least && value <= law.most;
    level.sd_w = law.residual_sd_w;
    if (is_through_origin(law.covariate)) {
        const double ratio = value / law.mean;
        level.power_w = std::max(0.0, law.mean_power_w * ratio);
        level.law_variance = 1.0 / flights;
        level.degrees_of_freedom = flights - 1.0;
        if (level.sd_w) *level.sd_w *= ratio;
        return level;
    }
    const double z = (std::clamp(value, law.least, law.most) - law.mean) / law.sd;
    level.power_w = std::max(0.0, law.mean_power_w + law.slope_w * z);
    // The ridge adds a flight one standard deviation off, so the squares of the standardised values sum to n.
    level.law_variance = (1.0 + z * z) / flights;
    level.degrees_of_freedom = flights - 2.0;
    return level;
}

ConstantPower constant_power(const RegressionPrediction& level) {
    ConstantPower power{level.power_w, std::nullopt, 0.0};
    if (!level.sd_w) return power;
    power.sd_w = *level.sd_w * std::sqrt(1.0 + level.law_variance);
    power.degrees_of_freedom = level.degrees_of_freedom;
    return power;
}

}  // namespace flightwatt::mechanical
