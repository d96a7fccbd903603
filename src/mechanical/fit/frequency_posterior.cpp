#include "mechanical/fit/frequency_posterior.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_likelihood.h"
#include "mechanical/fit/least_squares.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

namespace flightwatt::mechanical {
namespace {

constexpr double no_likelihood = -1e300;

/// A density by so much (its logarithm) behind its peak is left out.
constexpr double hopeless = 12.0;

/// Nodes that hold less than this of all weight together are left out.
constexpr double negligible_weight = 1e-4;

/// At a bound of the range the density is so much of its peak: the data do not end the interval there.
constexpr double open_density = 0.1;

/// Of all flights together: then the work is worth threads.
constexpr std::size_t many_samples = 5'000;

using FlightsAt = std::vector<FrequencyProjection>;

/// 1, or 0 for every core.
std::size_t threads_for(std::span<const ScaledSamples> flights) { return sample_count(flights) < many_samples ? 1 : 0; }

/// Empty if the samples of one of the flights determine no series there.
FlightsAt flights_at(std::span<const ScaledSamples> flights, int order, double theta_rad) {
    FlightsAt all(flights.size());
    std::atomic<bool> are_determined = true;
    const auto work = [&](std::size_t i) {
        auto flight = project_at_frequency(flights[i], order, theta_rad);
        if (flight) {
            all[i] = *std::move(flight);
        } else {
            are_determined = false;
        }
    };
    for_each_in_parallel(flights.size(), work, threads_for(flights));
    return are_determined ? all : FlightsAt();
}

/// The mean over the phase of the squares of a curve with these coefficients: c' (this) c.
Eigen::MatrixXd curve_gram(int order, double theta_rad) {
    constexpr int points = 64;
    std::vector<double> tau;
    tau.reserve(points);
    for (int i = 0; i < points; ++i) tau.push_back((i + 0.5) / points);
    const auto basis = fourier_basis(tau, order, theta_rad);
    return basis.transpose() * basis / points;
}

/// The weighted mean curve at one frequency and autocorrelation, its weight the logarithm of their likelihood. Degrees
/// of freedom are Satterthwaite's for the curve.
PosteriorNode node_of(const FlightsAt& flights, std::span<const double> weights, double theta_rad,
                      double autocorrelation) {
    const auto size = flights.front().coordinates.size();
    PosteriorNode node{theta_rad, autocorrelation, 0.0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
    const auto gram = curve_gram(static_cast<int>(size - 1) / 2, theta_rad);
    double squares = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto fit = restricted_likelihood(flights[i], autocorrelation);
        const auto& back = flights[i].from_orthonormal;
        const double variance = weights[i] * weights[i] * fit.square_sum / fit.degrees_of_freedom;
        const Eigen::MatrixXd share = variance * back * fit.covariance() * back.transpose();
        node.weight += fit.log_likelihood;
        node.coefficients += weights[i] * back * fit.coordinates;
        node.scale += share;
        squares += std::pow(gram.cwiseProduct(share).sum(), 2) / fit.degrees_of_freedom;
    }
    const double sum = gram.cwiseProduct(node.scale).sum();
    node.degrees_of_freedom = squares > 0.0 ? std::max(1.0, sum * sum / squares) : 1.0;
    return node;
}

/// The autocorrelations that the samples allow at the frequency of least squares, rising.
std::vector<DensityNode> likely_autocorrelations(const FlightsAt& flights, double highest) {
    constexpr int intervals = 6;
    std::vector<double> starts;
    for (int i = 0; i <= intervals; ++i) starts.push_back(highest * i / intervals);
    const auto log_density = [&](double r) {
        double sum = 0.0;
        for (const auto& flight : flights) sum += restricted_likelihood(flight, r).log_likelihood;
        return sum;
    };
    auto nodes = refine_density_nodes(log_density, starts);
    const double top = std::ranges::max_element(nodes, {}, &DensityNode::log_density)->log_density;
    std::erase_if(nodes, [&](const auto& node) { return node.log_density < top - hopeless; });
    return nodes;
}

/// Where the search for the density begins: both bounds, the frequency of least squares, and of the scan what is not
/// hopeless, with what lies beside it. Sums of squares of noise with this autocorrelation count as those of fewer
/// samples.
std::vector<double> frequencies_to_try(std::span<const ScaledSamples> flights, const PosteriorOptions& options,
                                       double autocorrelation) {
    constexpr std::size_t most = 100;
    const auto scan = scan_frequencies(flights, options.order, options.range);
    const double least = std::max(1e-300, *std::ranges::min_element(scan.square_sum));
    const double coefficients = static_cast<double>(flights.size()) * coefficient_count(options.order);
    const double freedom = static_cast<double>(sample_count(flights)) - coefficients;
    const double independent = freedom * (1.0 - autocorrelation) / (1.0 + autocorrelation);
    std::vector<std::pair<double, std::size_t>> found;  // behind the best, place in the scan
    for (std::size_t i = 0; i < scan.theta_rad.size(); ++i) {
        const double behind = 0.5 * independent * std::log(std::max(1.0, scan.square_sum[i] / least)) +
                              2.0 * std::log(scan.theta_rad[i] / options.least_squares_rad);
        if (behind < hopeless) found.emplace_back(behind, i);
    }
    std::ranges::sort(found);
    found.resize(std::min(found.size(), most));
    std::vector<double> tried{options.range.low_rad, options.range.high_rad, options.least_squares_rad};
    for (const auto& [behind, i] : found)
        for (std::size_t k = std::max<std::size_t>(i, 1) - 1; k < std::min(i + 2, scan.theta_rad.size()); ++k)
            tried.push_back(scan.theta_rad[k]);
    std::ranges::sort(tried);
    tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
    return tried;
}

/// Weights from their logarithms. The lightest nodes are left out; those of the others sum to 1.
void normalise(std::vector<PosteriorNode>& nodes) {
    std::vector<double> logs;
    logs.reserve(nodes.size());
    for (const auto& node : nodes) logs.push_back(node.weight);
    const double total = log_sum_exp(logs);
    std::ranges::sort(logs);
    double left_out = 0.0;
    auto heavy = logs.begin();
    while (left_out + std::exp(*heavy - total) < negligible_weight) left_out += std::exp(*heavy++ - total);
    std::erase_if(nodes, [&](const auto& node) { return node.weight < *heavy; });
    for (auto& node : nodes) node.weight = std::exp(node.weight - total) / (1.0 - left_out);
}

}  // namespace

double autocorrelation_limit(std::span<const ScaledSamples> flights) {
    constexpr double part_of_phase = 0.2;
    constexpr double least = 0.9;
    double highest = max_autocorrelation;
    for (const auto& samples : flights) {
        const double step = median_gap(samples.tau);
        highest = std::min(highest, std::max(least, std::exp(-step / part_of_phase)));
    }
    return highest;
}

FrequencyPosterior frequency_posterior(std::span<const ScaledSamples> unsorted, std::span<const double> weights,
                                       const PosteriorOptions& options) {
    std::vector<ScaledSamples> flights;
    for (const auto& samples : unsorted) flights.push_back(sort_by_time(samples));
    FrequencyPosterior posterior;
    posterior.max_autocorrelation = autocorrelation_limit(flights);
    const auto at_found = flights_at(flights, options.order, options.least_squares_rad);
    if (at_found.empty()) throw NoResultError("the times of the samples determine no series");
    auto autocorrelations = likely_autocorrelations(at_found, posterior.max_autocorrelation);
    for (auto& node : autocorrelations) node.log_density = 0.0;
    const auto widths = log_masses(autocorrelations);
    std::map<double, std::vector<PosteriorNode>> known;  // by frequency; weights are logarithms
    const auto log_density = [&](double theta_rad) {
        auto& nodes = known[theta_rad];
        const auto at = flights_at(flights, options.order, theta_rad);
        if (at.empty()) return no_likelihood;
        nodes.resize(widths.size());
        const auto work = [&](std::size_t i) { nodes[i] = node_of(at, weights, theta_rad, autocorrelations[i].x); };
        for_each_in_parallel(nodes.size(), work, threads_for(flights));
        std::vector<double> logs;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes[i].weight += widths[i] - 2.0 * std::log(theta_rad);
            logs.push_back(nodes[i].weight);
        }
        return log_sum_exp(logs);
    };
    std::vector<double> starts{options.least_squares_rad};
    if (options.order > 0) starts = frequencies_to_try(flights, options, autocorrelations.back().x);
    const auto density = refine_density_nodes(log_density, starts);
    const double top = std::ranges::max_element(density, {}, &DensityNode::log_density)->log_density;
    posterior.is_open_below = density.front().log_density > top + std::log(open_density);
    posterior.is_open_above = density.back().log_density > top + std::log(open_density);
    const auto masses = log_masses(density);
    for (std::size_t i = 0; i < density.size(); ++i) {
        for (auto& node : known[density[i].x]) {
            node.weight += masses[i] - density[i].log_density;
            posterior.nodes.push_back(std::move(node));
        }
    }
    normalise(posterior.nodes);
    return posterior;
}

bool is_autocorrelation_at_limit(const FrequencyPosterior& posterior) {
    constexpr double near_highest = 0.95;
    double weight = 0.0;
    for (const auto& node : posterior.nodes)
        if (node.autocorrelation > near_highest * posterior.max_autocorrelation) weight += node.weight;
    return weight > 0.5;
}

Interval frequency_interval(const FrequencyPosterior& posterior) {
    const double tail = (1.0 - confidence_level) / 2.0;
    Interval interval{posterior.nodes.front().theta_rad, posterior.nodes.back().theta_rad};
    double sum = 0.0;
    for (const auto& node : posterior.nodes) {
        if (sum < tail) interval.low = node.theta_rad;
        if (sum < 1.0 - tail) interval.high = node.theta_rad;
        sum += node.weight;
    }
    return interval;
}

}  // namespace flightwatt::mechanical
