#include "mechanical/flight_envelope.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {

std::optional<PhaseSpread> flight_envelope(const PhaseFit& fit, std::span<const double> weights,
                                           std::size_t points) {
    double squares = 0.0;
    for (const double weight : weights) squares += weight * weight;
    if (std::count_if(weights.begin(), weights.end(), [](double weight) { return weight > 0.0; }) < 2) {
        return std::nullopt;
    }
    PhaseSpread spread;
    spread.counted_flights = 1.0 / squares;
    for (std::size_t i = 0; i < points; ++i) {
        const double tau = static_cast<double>(i) / static_cast<double>(points - 1);
        std::vector<double> powers;
        std::vector<double> counts;
        double mean = 0.0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            if (weights[k] <= 0.0) continue;
            const auto& flight = fit.flights[k];
            powers.push_back(power_w(flight.fourier, tau * flight.duration_s));
            counts.push_back(weights[k]);
            mean += weights[k] * powers.back();
        }
        double square_sum = 0.0;
        for (std::size_t k = 0; k < powers.size(); ++k)
            square_sum += counts[k] * std::pow(powers[k] - mean, 2);
        const auto [low, high] = std::minmax_element(powers.begin(), powers.end());
        spread.low_w.push_back(*low);
        spread.high_w.push_back(*high);
        spread.standard_deviation_w.push_back(std::sqrt(square_sum / (1.0 - squares)));
    }
    return spread;
}

double population_standard_error_w(const PhaseSpread& spread, std::size_t i) {
    return spread.standard_deviation_w[i] / std::sqrt(spread.counted_flights);
}

}  // namespace flightwatt::mechanical
