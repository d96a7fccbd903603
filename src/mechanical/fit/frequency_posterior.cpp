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
#include <functional>
#include <numeric>

#include <boost/math/tools/minima.hpp>

namespace flightwatt::mechanical {
namespace {

constexpr double no_likelihood = -1e300;

/// Of the local maxima between the frequencies of the scan, as many are climbed.
constexpr std::size_t climbed_maxima = 8;
constexpr int climbed_bits = 20;

/// Nodes that hold less than this of all weight together are left out.
constexpr double negligible_weight = 1e-4;

/// Of all flights together: then they tell one frequency and one autocorrelation, and the work is worth threads.
constexpr std::size_t many_samples = 5'000;

/// 1, or 0 for every core.
std::size_t threads_for(std::size_t samples) { return samples < many_samples ? 1 : 0; }

using FlightsAt = std::vector<FrequencyProjection>;

std::size_t sample_count(const FlightsAt& flights) {
    std::size_t count = 0;
    for (const auto& flight : flights) count += flight.gap.size();
    return count;
}

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
    for_each_in_parallel(flights.size(), work, threads_for(mechanical::sample_count(flights)));
    return are_determined ? all : FlightsAt();
}

double log_likelihood(const FlightsAt& flights, double autocorrelation) {
    std::vector<double> parts(flights.size());
    const auto work = [&](std::size_t i) {
        parts[i] = restricted_likelihood(flights[i], autocorrelation).log_likelihood;
    };
    for_each_in_parallel(flights.size(), work, threads_for(sample_count(flights)));
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

/// One frequency, and the autocorrelations there.
struct FrequencyNode {
    double log_density = no_likelihood;  ///< of theta
    std::vector<DensityNode> autocorrelations;
};

/// `autocorrelations` are those to begin with, or all there is to know.
FrequencyNode node_at(std::span<const ScaledSamples> flights, const PosteriorOptions& options,
                      const std::vector<double>& autocorrelations, bool are_all, double theta_rad) {
    FrequencyNode node;
    const auto at = flights_at(flights, options.order, theta_rad);
    if (at.empty()) return node;
    const auto density = [&](double r) { return log_likelihood(at, r); };
    node.autocorrelations =
        are_all ? evaluate_density(density, autocorrelations) : refine_density_nodes(density, autocorrelations);
    node.log_density = log_sum_exp(log_masses(node.autocorrelations)) - 2.0 * std::log(theta_rad);
    return node;
}

/// The peak of the density near a frequency, for the autocorrelation that is likeliest there.
double climbed(std::span<const ScaledSamples> flights, const PosteriorOptions& options, double theta_rad,
               double autocorrelation) {
    const double reach = scan_grid(options.range, options.order).step_rad;
    const double low = std::max(options.range.low_rad, theta_rad - reach);
    const double high = std::min(options.range.high_rad, theta_rad + reach);
    const auto behind = [&](double theta) {
        const auto at = flights_at(flights, options.order, theta);
        return at.empty() ? -no_likelihood : 2.0 * std::log(theta) - log_likelihood(at, autocorrelation);
    };
    return boost::math::tools::brent_find_minima(behind, low, high, climbed_bits).first;
}

/// A frequency whose likelihood at the coarse autocorrelations is further behind the best than this is left out.
constexpr double hopeless = 12.0;

struct CoarseNode {
    double theta_rad = 0.0;
    double log_density = no_likelihood;
    double likeliest = 0.0;  ///< of the autocorrelations
};

CoarseNode coarse_node(std::span<const ScaledSamples> flights, const PosteriorOptions& options, double highest,
                       double theta_rad) {
    CoarseNode node{theta_rad};
    const auto at = flights_at(flights, options.order, theta_rad);
    if (at.empty()) return node;
    for (const double r : {0.0, highest / 3.0, highest / 1.5, highest}) {
        const double density = log_likelihood(at, r) - 2.0 * std::log(theta_rad);
        if (density <= node.log_density) continue;
        node.log_density = density;
        node.likeliest = r;
    }
    return node;
}

/// Where the search for the density begins: the frequencies of the screen with both bounds, and every peak.
std::vector<double> starts_of(std::span<const ScaledSamples> flights, const PosteriorOptions& options, double highest) {
    const auto& range = options.range;
    auto tried = candidate_frequencies(flights, options.order, range, options.least_squares_rad, highest);
    tried.insert(tried.end(), {range.low_rad, range.high_rad, options.least_squares_rad});
    std::ranges::sort(tried);
    tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
    std::vector<CoarseNode> nodes;
    nodes.reserve(tried.size());
    for (const double theta_rad : tried) nodes.push_back(coarse_node(flights, options, highest, theta_rad));
    std::vector<CoarseNode> maxima;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const bool rises = i == 0 || nodes[i].log_density >= nodes[i - 1].log_density;
        const bool falls = i + 1 == nodes.size() || nodes[i].log_density >= nodes[i + 1].log_density;
        if (rises && falls) maxima.push_back(nodes[i]);
    }
    std::ranges::sort(maxima, std::greater(), &CoarseNode::log_density);
    maxima.resize(std::min(maxima.size(), climbed_maxima));
    for (const auto& [theta_rad, log_density, r] : maxima) {
        nodes.push_back(coarse_node(flights, options, highest, climbed(flights, options, theta_rad, r)));
    }
    std::ranges::sort(nodes, {}, &CoarseNode::theta_rad);
    const double best = std::ranges::max_element(nodes, {}, &CoarseNode::log_density)->log_density;
    std::vector<double> starts;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        // With what lies beside it, for a peak is between its neighbours.
        const bool near = (i > 0 && nodes[i - 1].log_density > best - hopeless) ||
                          (i + 1 < nodes.size() && nodes[i + 1].log_density > best - hopeless);
        if (!near && nodes[i].log_density <= best - hopeless) continue;
        if (starts.empty() || nodes[i].theta_rad > starts.back()) starts.push_back(nodes[i].theta_rad);
    }
    return starts;
}

/// A peak that is nearly normal.
struct Peak {
    double place = 0.0;
    double sd = 0.0;
};

/// Places a standard deviation apart over the peak, as far as they lie between the bounds, which are places where the
/// peak reaches them: there trapezoids integrate a normal density to six digits.
std::vector<double> places_over(const Peak& peak, double low, double high) {
    constexpr int reach = 5;
    std::vector<double> places;
    for (int k = -reach; k <= reach; ++k) {
        const double place = std::clamp(peak.place + k * peak.sd, low, high);
        if (places.empty() || place > places.back()) places.push_back(place);
    }
    return places;
}

/// The standard deviation of a peak from the density beside it, from `width` down.
template <typename LogDensity>
double sd_of_peak(const LogDensity& log_density, double place, double width) {
    constexpr double near = 1.0;
    constexpr double smallest = 1e-9;
    const double top = log_density(place);
    double lost = top - log_density(place + width);
    while (lost > near && width > smallest * place) {
        width /= 2.0;
        lost = top - log_density(place + width);
    }
    return lost > 0.0 ? width / std::sqrt(2.0 * lost) : width;
}

/// Of many samples that tell one frequency.
std::vector<double> frequencies_about(std::span<const ScaledSamples> flights, const PosteriorOptions& options,
                                      double autocorrelation) {
    const auto density = [&](double theta_rad) {
        const auto at = flights_at(flights, options.order, theta_rad);
        return at.empty() ? no_likelihood : log_likelihood(at, autocorrelation) - 2.0 * std::log(theta_rad);
    };
    const double peak_rad = climbed(flights, options, options.least_squares_rad, autocorrelation);
    const double turned_rad = 0.5 / options.order;  // see is_frequency_determined
    return places_over({peak_rad, sd_of_peak(density, peak_rad, turned_rad)}, options.range.low_rad,
                       options.range.high_rad);
}

/// The autocorrelations there, at the frequency of least squares.
Peak autocorrelation_peak(std::span<const ScaledSamples> flights, const PosteriorOptions& options, double highest) {
    const auto at = flights_at(flights, options.order, options.least_squares_rad);
    const auto density = [&](double r) { return log_likelihood(at, r); };
    const auto behind = [&](double r) { return -density(r); };
    const double r = boost::math::tools::brent_find_minima(behind, 0.0, highest, climbed_bits).first;
    const double expected_sd = 1.0 / std::sqrt(static_cast<double>(mechanical::sample_count(flights)));
    return {r, sd_of_peak(density, r, std::min(4.0 * expected_sd, (highest - r) / 2.0))};
}

QuadratureNode posterior_node(const FlightsAt& flights, double theta_rad, double autocorrelation) {
    QuadratureNode node{theta_rad, autocorrelation};
    node.flights.resize(flights.size());
    std::vector<double> parts(flights.size());
    const auto work = [&](std::size_t i) {
        const auto evidence = restricted_likelihood(flights[i], autocorrelation);
        const auto& back = flights[i].from_orthonormal;
        const double variance = evidence.square_sum / evidence.degrees_of_freedom;
        parts[i] = evidence.log_likelihood;
        node.flights[i] = {back * evidence.coordinates, variance * back * evidence.covariance() * back.transpose(),
                           evidence.degrees_of_freedom};
    };
    for_each_in_parallel(flights.size(), work, threads_for(sample_count(flights)));
    node.log_likelihood = std::accumulate(parts.begin(), parts.end(), 0.0);
    return node;
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

MeanCurveNode mean_node(const QuadratureNode& node, std::span<const double> weights) {
    const auto size = node.flights.front().coefficients.size();
    MeanCurveNode mean{node.theta_rad,      node.autocorrelation,        node.weight,
                       node.log_likelihood, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
    const auto gram = curve_gram(static_cast<int>(size - 1) / 2, node.theta_rad);
    double squares = 0.0;
    for (std::size_t i = 0; i < node.flights.size(); ++i) {
        const auto& flight = node.flights[i];
        mean.coefficients += weights[i] * flight.coefficients;
        const Eigen::MatrixXd share = weights[i] * weights[i] * flight.scale;
        mean.scale += share;
        squares += std::pow(gram.cwiseProduct(share).sum(), 2) / flight.degrees_of_freedom;
    }
    const double sum = gram.cwiseProduct(mean.scale).sum();
    mean.degrees_of_freedom = squares > 0.0 ? std::max(1.0, sum * sum / squares) : 1.0;
    return mean;
}

/// Frequencies and autocorrelations with their masses; the lightest are left out.
struct WeighedPlace {
    std::size_t frequency = 0;  ///< which of the density's nodes
    double autocorrelation = 0.0;
    double weight = 0.0;
};

std::vector<WeighedPlace> weighed(const std::vector<DensityNode>& density, const std::vector<FrequencyNode>& nodes) {
    const auto masses = log_masses(density);
    const double total = log_sum_exp(masses);
    std::vector<WeighedPlace> places;
    for (std::size_t i = 0; i < density.size(); ++i) {
        if (nodes[i].autocorrelations.empty()) continue;
        const auto parts = log_masses(nodes[i].autocorrelations);
        const double all = log_sum_exp(parts);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            places.push_back({i, nodes[i].autocorrelations[k].x, std::exp(masses[i] - total + parts[k] - all)});
        }
    }
    std::ranges::stable_sort(places, {}, &WeighedPlace::weight);
    double left_out = 0.0;
    std::size_t light = 0;
    while (light + 1 < places.size() && left_out + places[light].weight < negligible_weight) {
        left_out += places[light++].weight;
    }
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(light));
    for (auto& place : places) place.weight /= 1.0 - left_out;
    std::ranges::stable_sort(places, {}, &WeighedPlace::frequency);
    return places;
}

}  // namespace

ScaledSamples sort_by_time(const ScaledSamples& samples) {
    if (std::ranges::is_sorted(samples.tau)) return samples;
    std::vector<std::size_t> places(samples.tau.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::ranges::stable_sort(places, {}, [&](std::size_t place) { return samples.tau[place]; });
    ScaledSamples sorted{{}, {}, samples.flight};
    for (const auto place : places) {
        sorted.tau.push_back(samples.tau[place]);
        sorted.value.push_back(samples.value[place]);
    }
    return sorted;
}

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

FrequencyPosterior frequency_posterior(std::span<const ScaledSamples> unsorted, const PosteriorOptions& options) {
    std::vector<ScaledSamples> flights;
    for (const auto& samples : unsorted) flights.push_back(sort_by_time(samples));
    FrequencyPosterior posterior;
    posterior.max_autocorrelation = autocorrelation_limit(flights);
    const double highest = posterior.max_autocorrelation;
    const bool is_told =
        options.order > 0 && mechanical::sample_count(flights) >= many_samples &&
        is_frequency_determined(flights, options.order, options.range, options.least_squares_rad, options.scan);
    std::vector<double> starts{options.least_squares_rad};
    auto autocorrelations = coarse_autocorrelations(highest);
    if (is_told) {
        const auto peak = autocorrelation_peak(flights, options, highest);
        autocorrelations = places_over(peak, 0.0, highest);
        starts = frequencies_about(flights, options, peak.place);
    } else if (options.order > 0) {
        starts = starts_of(flights, options, highest);
    }
    std::vector<std::pair<double, FrequencyNode>> known;
    const auto log_density = [&](double theta_rad) {
        known.emplace_back(theta_rad, node_at(flights, options, autocorrelations, is_told, theta_rad));
        return known.back().second.log_density;
    };
    const auto density = is_told ? evaluate_density(log_density, starts) : refine_density_nodes(log_density, starts);
    std::ranges::sort(known, {}, &std::pair<double, FrequencyNode>::first);
    std::vector<FrequencyNode> nodes;
    nodes.reserve(known.size());
    for (auto& [theta_rad, node] : known) nodes.push_back(std::move(node));
    const double top = std::ranges::max_element(density, {}, &DensityNode::log_density)->log_density;
    if (top <= no_likelihood) throw NoResultError("the times of the samples determine no series at any frequency");
    for (const auto& [theta_rad, log_value] : density) {
        posterior.theta_rad.push_back(theta_rad);
        posterior.density.push_back(std::exp(log_value - top));
    }
    FlightsAt at;
    std::size_t computed = density.size();
    for (const auto& [frequency, autocorrelation, weight] : weighed(density, nodes)) {
        const double theta_rad = density[frequency].x;
        if (computed != frequency) at = flights_at(flights, options.order, theta_rad);
        computed = frequency;
        posterior.nodes.push_back(posterior_node(at, theta_rad, autocorrelation));
        posterior.nodes.back().weight = weight;
    }
    const auto likeliest = std::ranges::max_element(posterior.nodes, {}, &QuadratureNode::log_likelihood);
    const double greatest = likeliest->log_likelihood;
    for (auto& node : posterior.nodes) node.log_likelihood -= greatest;
    return posterior;
}

std::vector<MeanCurveNode> mean_curve_nodes(const FrequencyPosterior& posterior, std::span<const double> weights) {
    std::vector<MeanCurveNode> nodes;
    for (const auto& node : posterior.nodes) nodes.push_back(mean_node(node, weights));
    return nodes;
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
