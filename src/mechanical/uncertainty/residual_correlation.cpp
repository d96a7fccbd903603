#include "mechanical/uncertainty/residual_correlation.h"

#include <cmath>

namespace flightwatt::mechanical {

std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation) {
    std::vector<double> correlation(tau.size(), 0.0);
    for (std::size_t j = 1; j < tau.size(); ++j) {
        correlation[j] = std::pow(autocorrelation, (tau[j] - tau[j - 1]) / step);
    }
    return correlation;
}

double effective_samples(std::span<const double> correlation) {
    const auto count = static_cast<double>(correlation.size());
    double earlier = 0.0;  // the correlations of sample j with all before it
    double sum = count;
    for (const double decay : correlation) {
        earlier = decay * (1.0 + earlier);
        sum += 2.0 * earlier;
    }
    return count * count / sum;
}

}  // namespace flightwatt::mechanical
