#include "mechanical/fit/flight_weights.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flightwatt::mechanical {
namespace {

/// Curves with a smaller relative difference are equal.
constexpr double equal_level = 1e-9;

/// Mean square distance of each flight's curve from the mean of the others over the phase [W^2].
std::vector<double> disagreements(const PhaseFit& fit) {
    const auto& first = fit.flights.front();
    const auto points = curve_point_count(first.fourier, first.duration_s);
    std::vector<std::vector<double>> curves;
    std::vector<double> sum(points, 0.0);
    for (const auto& flight : fit.flights) {
        curves.push_back(curve_w(flight.fourier, flight.duration_s, points));
        for (std::size_t i = 0; i < points; ++i) sum[i] += curves.back()[i];
    }
    const auto others = static_cast<double>(curves.size() - 1);
    double size = 0.0;
    for (const double value : sum) size += std::pow(value / (others + 1.0), 2) / static_cast<double>(points);
    std::vector<double> distances;
    for (const auto& curve : curves) {
        double square_sum = 0.0;
        for (std::size_t i = 0; i < points; ++i) square_sum += std::pow(curve[i] - (sum[i] - curve[i]) / others, 2);
        const double distance = square_sum / static_cast<double>(points);
        distances.push_back(distance > equal_level * equal_level * size ? distance : 0.0);
    }
    return distances;
}

}  // namespace

std::vector<double> flight_weights(const PhaseFit& fit, Weighting weighting) {
    const auto count = fit.flights.size();
    std::vector<double> weights(count, 1.0 / static_cast<double>(count));
    if (weighting == Weighting::uniform || count <= 2) return weights;
    const auto distances = disagreements(fit);
    double typical = median(distances);
    if (typical == 0.0) typical = mean(distances);
    if (typical == 0.0) return weights;
    std::ranges::transform(distances, weights.begin(), [&](double distance) { return typical / (distance + typical); });
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

PhaseModel average_phase(const PhaseFit& fit, std::span<const double> weights) {
    PhaseModel model;
    model.rms_w = fit.rms_w;
    model.range = fit.range;
    model.samples = fit.samples;
    model.flights = fit.flights.size();
    model.open_frequency = !fit.rivals_rad.empty();
    model.not_negative = fit.is_clamped;
    model.fourier.cos_w.resize(fit.flights.front().fourier.cos_w.size());
    model.fourier.sin_w.resize(model.fourier.cos_w.size());
    for (std::size_t i = 0; i < fit.flights.size(); ++i) {
        const auto& flight = fit.flights[i];
        model.duration_s += weights[i] * flight.duration_s;
        model.fourier.a0_w += weights[i] * flight.fourier.a0_w;
        for (std::size_t n = 0; n < model.fourier.cos_w.size(); ++n) {
            model.fourier.cos_w[n] += weights[i] * flight.fourier.cos_w[n];
            model.fourier.sin_w[n] += weights[i] * flight.fourier.sin_w[n];
        }
    }
    model.fourier.omega_rad_per_s = fit.theta_rad / model.duration_s;
    return model;
}

}  // namespace flightwatt::mechanical
