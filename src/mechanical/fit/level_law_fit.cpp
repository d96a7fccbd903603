#include "mechanical/fit/level_law_fit.h"

#include "base/statistics.h"

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
            goes_through_origin(covariate) ? flight.airspeed_cubed_m3_per_s3 : flight.covariates[covariate];
        if (!value || (goes_through_origin(covariate) && *value <= 0.0)) continue;
        points.covariate.push_back(*value);
        points.power_w.push_back(mean_power_w(flight));
    }
    return points;
}

/// Each flight's own coefficient counts the same.
void fit_through_origin(LevelLaw& law, const Points& points) {
    std::vector<double> coefficients;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        coefficients.push_back(points.power_w[i] / points.covariate[i]);
    }
    law.mean_power_w = mean(coefficients) * law.mean;
    law.slope_w = mean(coefficients) * law.sd;
    law.residual_sd_w = sample_sd(coefficients) * law.mean;
}

void fit_line(LevelLaw& law, const Points& points) {
    const auto flights = static_cast<double>(law.flights);
    double product_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        product_sum += (points.covariate[i] - law.mean) / law.sd * (points.power_w[i] - law.mean_power_w);
    }
    law.slope_w = product_sum / flights;
    if (law.flights < least_flights_of_law(law.covariate)) return;
    double residual_square_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        const double fitted_w = law.mean_power_w + law.slope_w * (points.covariate[i] - law.mean) / law.sd;
        residual_square_sum += std::pow(points.power_w[i] - fitted_w, 2);
    }
    law.residual_sd_w = std::sqrt(residual_square_sum / (flights - 2.0));
}

}  // namespace

std::optional<LevelLaw> fit_level_law(std::span<const PhaseSamples> flights, Covariate covariate) {
    const auto points = points_of(flights, covariate);
    if (points.covariate.size() < 2 || !(sample_sd(points.covariate) > 0.0)) return std::nullopt;
    const auto [least, most] = std::minmax_element(points.covariate.begin(), points.covariate.end());
    LevelLaw law{.covariate = covariate,
                 .flights = points.covariate.size(),
                 .mean = mean(points.covariate),
                 .sd = sample_sd(points.covariate),
                 .least = *least,
                 .most = *most,
                 .mean_power_w = mean(points.power_w),
                 .slope_w = 0.0,
                 .residual_sd_w = std::nullopt};
    if (!goes_through_origin(covariate)) {
        fit_line(law, points);
        return law;
    }
    fit_through_origin(law, points);
    if (!(law.mean_power_w > 0.0)) return std::nullopt;
    return law;
}

std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> others, Covariate covariate,
                                                const std::optional<double>& value) {
    const auto law = fit_level_law(others, covariate);
    if (!value || !law) return std::nullopt;
    return constant_power(level_at(*law, *value));
}

}  // namespace flightwatt::mechanical
