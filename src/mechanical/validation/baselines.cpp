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

ConstantPower single_flight_power(std::span<const PhaseSamples> flights, std::size_t index) {
    const auto powers_w = mean_powers_w(flights);
    return with_spread(powers_w[index], powers_w, std::sqrt(2.0));
}

std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> flights, Covariate covariate,
                                                const std::optional<double>& value) {
    const auto law = fit_covariate_regression(flights, covariate);
    if (!value || !law) return std::nullopt;
    return constant_power(predict_mean_power(*law, *value));
}

EnergyEstimate energy_of(const ConstantPower& power, double duration_s) {
    EnergyEstimate estimate{units::wh_from_joule(power.mean_w * duration_s), power.sd_w.has_value(), 0.0, 0.0};
    if (power.sd_w) {
        const double sd_wh = units::wh_from_joule(*power.sd_w * duration_s);
        add_variance(estimate, {sd_wh * sd_wh, power.degrees_of_freedom});
    }
    return estimate;
}

std::optional<std::size_t> nearest_flight(std::span<const FlightSamples> flights, flight::Phase phase,
                                          const FlightSamples& other) {
    std::optional<std::size_t> nearest;
    double least = 0.0;
    std::size_t index = 0;
    for (const auto& flight : flights) {
        if (!flight.phases[phase]) continue;
        double square_sum = 0.0;
        int common = 0;
        for (const auto p : flight::all_phases) {
            if (!flight.phases[p] || !other.phases[p]) continue;
            square_sum += std::pow(std::log(other.phases[p]->duration_s / flight.phases[p]->duration_s), 2);
            ++common;
        }
        const double distance = square_sum / common;
        if (common > 0 && (!nearest || distance < least)) {
            nearest = index;
            least = distance;
        }
        ++index;
    }
    return nearest;
}

}  // namespace flightwatt::mechanical
