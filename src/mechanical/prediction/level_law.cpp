#include "mechanical/prediction/level_law.h"

#include "mechanical/moments.h"
#include "mechanical/prediction/level_spread.h"

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
        // The airspeed law rests on whole phases; only the flight to be foretold is known early alone.
        const auto& value = covariate == Covariate::airspeed_cubed ? flight.airspeed_cubed_m3_per_s3
                                                                   : flight.covariates[covariate];
        if (!value) continue;
        points.covariate.push_back(*value);
        points.power_w.push_back(mean_power_w(flight));
    }
    return points;
}

/// The square sum of the standardised covariate, with the ridge: one more flight, one standard deviation off.
double ridge_square_sum(const LevelLaw& law) { return static_cast<double>(law.flights); }

void fit_line(LevelLaw& law, const Points& points) {
    double product_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        product_sum += (points.covariate[i] - law.mean) / law.sd * (points.power_w[i] - law.mean_power_w);
    }
    law.slope_w = product_sum / ridge_square_sum(law);
    if (law.flights < 3) return;
    double residual_square_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        const double fitted_w = law.mean_power_w + law.slope_w * (points.covariate[i] - law.mean) / law.sd;
        residual_square_sum += std::pow(points.power_w[i] - fitted_w, 2);
    }
    law.residual_sd_w = std::sqrt(residual_square_sum / (static_cast<double>(law.flights) - 2.0));
}

}  // namespace

std::optional<LevelLaw> level_law(std::span<const PhaseSamples> flights, Covariate covariate) {
    const auto points = points_of(flights, covariate);
    if (points.covariate.size() < 2 || !(sample_sd(points.covariate) > 0.0)) return std::nullopt;
    const auto [least, most] = std::minmax_element(points.covariate.begin(), points.covariate.end());
    LevelLaw law{covariate,
                 points.covariate.size(),
                 mean_of(points.covariate),
                 sample_sd(points.covariate),
                 *least,
                 *most,
                 mean_of(points.power_w),
                 0.0,
                 std::nullopt};
    if (covariate != Covariate::airspeed_cubed) {
        fit_line(law, points);
        return law;
    }
    const auto airspeed = airspeed_law(flights);
    if (!airspeed) return std::nullopt;
    law.mean_power_w = airspeed->coefficient_w_s3_per_m3 * law.mean;
    law.slope_w = airspeed->coefficient_w_s3_per_m3 * law.sd;
    law.residual_sd_w = airspeed->relative_sd * law.mean_power_w;
    return law;
}

LawLevel level_at(const LevelLaw& law, double value) {
    const bool through_origin = law.covariate == Covariate::airspeed_cubed;
    const double held = through_origin ? value : std::clamp(value, law.least, law.most);
    const double z = (held - law.mean) / law.sd;
    const auto flights = static_cast<double>(law.flights);
    LawLevel level;
    level.power_w = std::max(0.0, law.mean_power_w + law.slope_w * z);
    level.within_flights = value >= law.least && value <= law.most;
    level.law_variance = 1.0 / flights + (through_origin ? 0.0 : z * z / ridge_square_sum(law));
    level.freedom = flights - (through_origin ? 1.0 : 2.0);
    level.sd_w = law.residual_sd_w;
    if (level.sd_w && through_origin) *level.sd_w *= level.power_w / law.mean_power_w;
    return level;
}

ConstantPower constant_power(const LawLevel& level) {
    ConstantPower power{level.power_w, std::nullopt, 0.0};
    if (!level.sd_w) return power;
    power.sd_w = *level.sd_w * std::sqrt(1.0 + level.law_variance);
    power.freedom = level.freedom;
    return power;
}

}  // namespace flightwatt::mechanical
