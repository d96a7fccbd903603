#include "mechanical/down_weighted.h"

#include <algorithm>

namespace flightwatt::mechanical {
namespace {

constexpr double hardly_counted = 0.5;

}  // namespace

std::vector<DownWeightedSample> down_weighted_samples(std::span<const PhaseSamples> flights,
                                                      const PhaseFit& fit) {
    std::vector<DownWeightedSample> found;
    if (fit.loss == Loss::none || fit.loss_scale_w <= 0.0) return found;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& samples = flights[i];
        for (std::size_t j = 0; j < samples.tau.size(); ++j) {
            const double time_s = samples.tau[j] * samples.duration_s;
            const double residual_w = samples.power_w[j] - power_w(fit.flights[i].fourier, time_s);
            const double weight = sample_weight(fit.loss, residual_w / fit.loss_scale_w);
            if (weight < hardly_counted) {
                found.push_back({samples.flight, samples.start_s + time_s, residual_w, weight});
            }
        }
    }
    std::sort(found.begin(), found.end(),
              [](const DownWeightedSample& a, const DownWeightedSample& b) { return a.weight < b.weight; });
    return found;
}

}  // namespace flightwatt::mechanical
