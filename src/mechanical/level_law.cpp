#include "mechanical/level_law.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {

LawLevel level_at(const LevelLaw& law, double value) {
    const auto flights = static_cast<double>(law.flights);
    LawLevel level;
    level.within_flights = value >= law.least && value <= law.most;
    level.sd_w = law.residual_sd_w;
    if (goes_through_origin(law.covariate)) {
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

ConstantPower constant_power(const LawLevel& level) {
    ConstantPower power{level.power_w, std::nullopt, 0.0};
    if (!level.sd_w) return power;
    power.sd_w = *level.sd_w * std::sqrt(1.0 + level.law_variance);
    power.degrees_of_freedom = level.degrees_of_freedom;
    return power;
}

}  // namespace flightwatt::mechanical
