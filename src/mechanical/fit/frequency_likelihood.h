#pragma once

#include "mechanical/phase_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace flightwatt::mechanical {

/// One flight's samples about its best series at one frequency.
struct FrequencyProjection {
    Eigen::MatrixXd columns;           ///< orthonormal columns of the basis and, last, the residuals
    Eigen::MatrixXd from_orthonormal;  ///< coefficients = this * coordinates
    Eigen::VectorXd coordinates;       ///< of least squares
    std::vector<double> gap;           ///< to the sample before, in median gaps; the first is 0
    double rounding = 0.0;             ///< a sum of squares below this is rounding
};

/// `samples` rise in time. std::nullopt where they do not determine a series of the order.
std::optional<FrequencyProjection> project_at_frequency(const ScaledSamples& samples, int order, double theta_rad);

/// The gaps between samples in median gaps, as noise forgets them. Samples at (almost) one time count as a quarter of a
/// gap apart: two that differ could not be, were their noise the same.
std::vector<double> normalised_gaps(const ScaledSamples& samples);

/// What one flight says of an autocorrelation r of its noise (R_jk = r^(gaps between), docs/methods.md, Eq. 11).
struct RestrictedLikelihood {
    double log_likelihood = 0.0;           ///< coefficients and the noise's variance integrated out
    double square_sum = 0.0;               ///< e'R^-1 e of generalised least squares
    double degrees_of_freedom = 0.0;       ///< samples less coefficients
    Eigen::VectorXd coordinates;           ///< generalised least squares, in the orthonormal basis
    Eigen::LLT<Eigen::MatrixXd> cholesky;  ///< of the whitened basis's gram matrix
    /// Of the coordinates, for noise of variance 1.
    Eigen::MatrixXd covariance() const {
        return cholesky.solve(Eigen::MatrixXd::Identity(coordinates.size(), coordinates.size()));
    }
};

/// Restricted likelihood |R|^-1/2 |Q'R^-1 Q|^-1/2 SSE^(-(n - k)/2), Q the orthonormal basis: the prior of the
/// coefficients is flat on that basis, so that a frequency does not count more because its harmonics are alike.
RestrictedLikelihood restricted_likelihood(const FrequencyProjection& flight, double autocorrelation);

/// The logarithm of a density, without its constant factor, at one place.
struct DensityNode {
    double x = 0.0;
    double log_density = 0.0;
};

/// Nodes that resolve a density: `starts` (rising) and, wherever the density is not negligible, as many between them
/// as it takes for neighbours to differ by no more than a factor of two. A peak is found if one of the starts is on it
/// or if it spans several of them.
template <typename LogDensity>
std::vector<DensityNode> refine_density_nodes(const LogDensity& log_density, const std::vector<double>& starts) {
    constexpr double negligible = 7.0;    // e^-7 of the peak
    constexpr double resolved = 0.7;      // a factor of two
    constexpr double steep = 2.0;         // beside a steep interval even a level one is split: a peak may be inside
    constexpr double same_place = 1e-10;  // relative
    constexpr int max_rounds = 40;
    constexpr std::size_t max_nodes = 600;
    std::vector<DensityNode> nodes;
    nodes.reserve(starts.size());
    for (const double place : starts) nodes.push_back({place, log_density(place)});
    for (int round = 0; round < max_rounds && nodes.size() < max_nodes; ++round) {
        const double top = std::ranges::max_element(nodes, {}, &DensityNode::log_density)->log_density;
        const auto rise = [&](std::size_t i) {
            return i + 1 < nodes.size() ? std::abs(nodes[i + 1].log_density - nodes[i].log_density) : 0.0;
        };
        std::vector<DensityNode> added;
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
            const auto& [low, low_log] = nodes[i];
            const auto& [high, high_log] = nodes[i + 1];
            if (std::max(low_log, high_log) < top - negligible || high - low <= same_place * std::abs(high)) continue;
            const double beside = std::max(i > 0 ? rise(i - 1) : 0.0, rise(i + 1));
            if (rise(i) <= resolved && beside <= steep) continue;
            const double middle = (low + high) / 2.0;
            added.push_back({middle, log_density(middle)});
        }
        if (added.empty()) break;
        nodes.insert(nodes.end(), added.begin(), added.end());
        std::ranges::sort(nodes, {}, &DensityNode::x);
    }
    return nodes;
}

/// Each node's part of the integral by trapezoids, as a logarithm; a single node counts as its density.
inline std::vector<double> log_masses(const std::vector<DensityNode>& nodes) {
    std::vector<double> masses;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double before = i > 0 ? nodes[i].x - nodes[i - 1].x : 0.0;
        const double after = i + 1 < nodes.size() ? nodes[i + 1].x - nodes[i].x : 0.0;
        const double width = nodes.size() > 1 ? (before + after) / 2.0 : 1.0;
        masses.push_back(nodes[i].log_density + std::log(width));
    }
    return masses;
}

/// log sum exp.
inline double log_sum_exp(const std::vector<double>& logs) {
    const double top = *std::ranges::max_element(logs);
    double sum = 0.0;
    for (const double value : logs) sum += std::exp(value - top);
    return top + std::log(sum);
}

}  // namespace flightwatt::mechanical
