#include "mechanical/validation/baselines.h"

#include "base/statistics.h"
#include "base/units.h"

#include <cmath>
#include <vector>

namespace flightwatt::mechanical {
namespace {

std::vector<double> mean_powers_w(std::span<const PhaseSamples> flights) {
    std::vector<double> powers_w;
    for (const auto& flight : flights) powers_w.push_back(mean_power_w(flight));
    return powers_w;
}

/// With the flights' standard deviation times `factor`, where there are two or more.
ConstantPower with_spread(double mean_w, const std::vector<double>& powers_w, double factor) {
    ConstantPower power{mean_w, std::nullopt, 0.0};
    if (powers_w.size() < 2) return power;
    power.sd_w = sample_sd(powers_w) * factor;
    power.degrees_of_freedom = static_cast<double>(powers_w.size() - 1);
    return power;
}

}  // namespace

ConstantPower constant_mean(std::span<const PhaseSamples> flights) {
    const auto powers_w = mean_powers_w(flights);
    return with_spread(mean(powers_w), powers_w, std::sqrt(1.0 + 1.0 / static_cast<double>(flights.size())));
}

ConstantPower power_of_flight(std::span<const PhaseSamples> flights, std::size_t index) {
    const auto powers_w = mean_powers_w(flights);
    return with_spread(powers_w[index], powers_w, std::sqrt(2.0));
}

EnergyEstimate energy_of(const ConstantPower& power, double duration_s) {
    EnergyEstimate estimate{units::wh_from_joule(power.mean_w * duration_s), power.sd_w.has_value(), 0.0,
                            0.0};
    if (power.sd_w) {
        const double sd_wh = units::wh_from_joule(*power.sd_w * duration_s);
        add_share(estimate, {sd_wh * sd_wh, power.degrees_of_freedom});
    }
    return estimate;
}

std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights,
                                          const flight::PerPhase<std::optional<double>>& duration_s) {
    std::optional<std::size_t> nearest;
    double least = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        double square_sum = 0.0;
        int common = 0;
        for (const auto phase : flight::all_phases) {
            if (!flights[i].phases[phase] || !duration_s[phase]) continue;
            const double ratio = std::log(*duration_s[phase] / flights[i].phases[phase]->duration_s);
            square_sum += ratio * ratio;
            ++common;
        }
        if (common == 0) continue;
        const double distance = square_sum / common;
        if (nearest && distance >= least) continue;
        nearest = i;
        least = distance;
    }
    return nearest;
}

}  // namespace flightwatt::mechanical
