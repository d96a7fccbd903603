#include "mechanical/flight_spread.h"

#include <cmath>
#include <random>

namespace flightwatt {
namespace {

/// Shifts one value of every flight so that they average to `mean`.
template <typename Access>
void centre(std::vector<FlightDeviation>& deviations, double mean, Access&& access) {
    double sum = 0.0;
    for (auto& deviation : deviations) sum += access(deviation);
    const double shift = mean - sum / static_cast<double>(deviations.size());
    for (auto& deviation : deviations) access(deviation) += shift;
}

}  // namespace

double band_w(Phase phase, double tau) {
    switch (phase) {
        case Phase::takeoff: return 0.2 + 1.3 * (1.0 - tau) * (1.0 - tau);
        case Phase::cruise: return 0.6;
        case Phase::landing: return 0.7 + 1.8 * (2.0 * tau - 1.0) * (2.0 * tau - 1.0);
    }
    return 0.0;
}

std::vector<FlightDeviation> draw_deviations(std::size_t count, std::uint64_t seed, double duration_spread) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> uniform(-duration_spread, duration_spread);
    std::vector<FlightDeviation> deviations(count);
    for (auto& deviation : deviations) {
        for (const auto phase : all_phases) {
            deviation.level[phase] = normal(random);
            deviation.tilt[phase] = 0.5 * normal(random);
            deviation.duration_factor[phase] = 1.0 + uniform(random);
        }
    }
    if (deviations.empty()) return deviations;
    for (const auto phase : all_phases) {
        centre(deviations, 0.0, [&](FlightDeviation& d) -> double& { return d.level[phase]; });
        centre(deviations, 0.0, [&](FlightDeviation& d) -> double& { return d.tilt[phase]; });
        centre(deviations, 1.0, [&](FlightDeviation& d) -> double& { return d.duration_factor[phase]; });
    }
    return deviations;
}

double deviation_w(const FlightDeviation& deviation, Phase phase, double tau) {
    return band_w(phase, tau) * (deviation.level[phase] + deviation.tilt[phase] * (2.0 * tau - 1.0));
}

}  // namespace flightwatt
