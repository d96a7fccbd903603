#include "mechanical/fit/phase_samples.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::mechanical {

double mean_power_w(const PhaseSamples& samples) {
    double sum = samples.power_w.front() * samples.tau.front();
    for (std::size_t i = 1; i < samples.tau.size(); ++i) {
        sum += 0.5 * (samples.power_w[i] + samples.power_w[i - 1]) * (samples.tau[i] - samples.tau[i - 1]);
    }
    return sum + samples.power_w.back() * (1.0 - samples.tau.back());
}

bool is_constant(std::span<const PhaseSamples> flights) {
    constexpr double rounding = 1e-12;
    return std::ranges::all_of(flights, [](const PhaseSamples& samples) {
        const auto [least, most] = std::ranges::minmax(samples.power_w);
        return most - least <= rounding * std::max(std::abs(least), std::abs(most));
    });
}

double median_gap(std::vector<double> tau) {
    std::sort(tau.begin(), tau.end());
    std::vector<double> gaps;
    for (std::size_t i = 1; i < tau.size(); ++i)
        if (tau[i] > tau[i - 1]) gaps.push_back(tau[i] - tau[i - 1]);
    return gaps.empty() ? 0.0 : median(std::move(gaps));
}

std::size_t sample_count(std::span<const ScaledSamples> flights) {
    std::size_t count = 0;
    for (const auto& flight : flights) count += flight.tau.size();
    return count;
}

}  // namespace flightwatt::mechanical
