#include "mechanical/fit/flight_variation.h"

#include "base/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace flightwatt::mechanical {
namespace {

constexpr double block_s = 30.0;
constexpr std::size_t min_blocks = 10;  // of the shortest flight

/// One flight's deviation from the model's curve at the flight's own level, in blocks; NaN without samples (gaps in the
/// telemetry).
std::vector<double> block_deviations_w(const PhaseModel& model, const PhaseSamples& flight, std::size_t blocks) {
    const auto curve = time_scaled_model(model, flight.duration_s, PhaseTimeScaling::scaled);
    std::vector<double> deviations_w(blocks, 0.0);
    std::vector<double> samples(blocks, 0.0);
    for (std::size_t i = 0; i < flight.tau.size(); ++i) {
        const auto block = std::min(static_cast<std::size_t>(flight.tau[i] * static_cast<double>(blocks)), blocks - 1);
        deviations_w[block] += flight.power_w[i] - power_w(curve, flight.tau[i] * flight.duration_s);
        samples[block] += 1.0;
    }
    std::vector<double> filled_w;
    for (std::size_t b = 0; b < blocks; ++b) {
        deviations_w[b] /= samples[b];
        if (samples[b] > 0.0) filled_w.push_back(deviations_w[b]);
    }
    for (double& deviation_w : deviations_w) deviation_w -= mean(filled_w);
    return deviations_w;
}

/// Sums over all flights' blocks.
struct BlockSums {
    double square = 0.0;
    double product = 0.0;  ///< of neighbours
    std::size_t blocks = 0;
    std::size_t neighbours = 0;
    double half_difference_square = 0.0;  ///< second half of the phase less the first, over the flights
    std::size_t flights = 0;
};

void add_blocks(BlockSums& sums, const std::vector<double>& deviations) {
    std::array<double, 2> half_sum{};
    std::array<std::size_t, 2> half_blocks{};
    for (std::size_t b = 0; b < deviations.size(); ++b) {
        if (std::isnan(deviations[b])) continue;
        sums.square += deviations[b] * deviations[b];
        ++sums.blocks;
        const std::size_t half = 2 * b < deviations.size() ? 0 : 1;
        half_sum[half] += deviations[b];
        ++half_blocks[half];
        if (b == 0 || std::isnan(deviations[b - 1])) continue;
        sums.product += deviations[b] * deviations[b - 1];
        ++sums.neighbours;
    }
    if (half_blocks[0] == 0 || half_blocks[1] == 0) return;
    const double difference =
        half_sum[1] / static_cast<double>(half_blocks[1]) - half_sum[0] / static_cast<double>(half_blocks[0]);
    sums.half_difference_square += difference * difference;
    ++sums.flights;
}

/// The correlation time at which means over neighbouring blocks, less their mean over a phase, have that correlation.
/// By bisection, from a tenth of a block, where neighbours are nearly independent, to the duration of a phase.
double correlation_time_s(double correlation_of_means, double length_s, double duration_s) {
    double low_s = 0.1 * length_s;
    double high_s = duration_s;
    constexpr int halvings = 50;
    for (int i = 0; i < halvings; ++i) {
        const DriftProcess drift{1.0, 0.5 * (low_s + high_s)};
        const double of_level_w2 = variance_of_mean_w2(drift, duration_s);
        const double correlation = (covariance_of_means_w2(drift, length_s, length_s) - of_level_w2) /
                                   (variance_of_mean_w2(drift, length_s) - of_level_w2);
        (correlation < correlation_of_means ? low_s : high_s) = drift.correlation_s;
    }
    return 0.5 * (low_s + high_s);
}

/// The drift whose means over blocks, less their mean over a phase, have the correlation and the variance of the
/// blocks, or the larger variance of the phases' halves, which power that rises or falls throughout has.
DriftProcess drift_of(const BlockSums& sums, double length_s, double duration_s) {
    if (!(sums.square > 0.0) || sums.neighbours == 0 || sums.flights < 2) return {0.0, length_s};
    const double variance = sums.square / static_cast<double>(sums.blocks);
    const double correlation = sums.product / static_cast<double>(sums.neighbours) / variance;
    const DriftProcess unit{1.0, correlation_time_s(correlation, length_s, duration_s)};
    const double by_blocks = variance / (variance_of_mean_w2(unit, length_s) - variance_of_mean_w2(unit, duration_s));
    // The model's curve is the flights' own average, which takes a part of their differences from it.
    const double half_difference = sums.half_difference_square / static_cast<double>(sums.flights - 1);
    const double by_halves = half_difference / (2.0 * variance_of_mean_w2(unit, 0.5 * duration_s) -
                                                2.0 * covariance_of_means_w2(unit, 0.5 * duration_s, 0.5 * duration_s));
    return {std::sqrt(std::max(by_blocks, by_halves)), unit.correlation_s};
}

}  // namespace

std::optional<VarianceComponents> estimate_variance_components(const PhaseModel& model,
                                                               std::span<const PhaseSamples> flights) {
    if (flights.size() < 2) return std::nullopt;
    std::vector<double> levels_w;
    double min_s = flights.front().duration_s;
    double sum_s = 0.0;
    for (const auto& flight : flights) {
        levels_w.push_back(mean_power_w(flight));
        min_s = std::min(min_s, flight.duration_s);
        sum_s += flight.duration_s;
    }
    const double length_s = std::min(block_s, min_s / static_cast<double>(min_blocks));
    BlockSums sums;
    for (const auto& flight : flights) {
        const auto blocks = static_cast<std::size_t>(std::floor(flight.duration_s / length_s));
        add_blocks(sums, block_deviations_w(model, flight, blocks));
    }
    const auto drift = drift_of(sums, length_s, sum_s / static_cast<double>(flights.size()));
    return VarianceComponents{flights.size(), sample_sd(levels_w), drift.sd_w, drift.correlation_s};
}

ConstantPower constant_mean(std::span<const PhaseSamples> flights) {
    std::vector<double> powers_w;
    for (const auto& flight : flights) powers_w.push_back(mean_power_w(flight));
    ConstantPower power{mean(powers_w), std::nullopt, 0.0};
    if (powers_w.size() < 2) return power;
    const auto count = static_cast<double>(powers_w.size());
    power.sd_w = sample_sd(powers_w) * std::sqrt(1.0 + 1.0 / count);
    power.degrees_of_freedom = count - 1.0;
    return power;
}

}  // namespace flightwatt::mechanical
