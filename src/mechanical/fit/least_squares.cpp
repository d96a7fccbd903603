#include "mechanical/fit/least_squares.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Phase of the highest harmonic between two thetas of the scan: half of it, from the middle of the phase, costs at
/// most this fraction of a harmonic's power.
constexpr double turn_between_rad = 1.0;
constexpr double lost_between_fraction = 0.02;

/// Minima of the scan that are refined. One that explains less than this fraction of the best explanation cannot become
/// the best within a step.
constexpr std::size_t refined_minima = 8;
constexpr double candidate_fraction = 0.95;

/// Probability of a harmonic that is noise.
constexpr double harmonic_significance = 1e-3;

/// A harmonic with less than this fraction of the power that the series explains is negligible.
constexpr double negligible_fraction = 0.02;

/// Below this fraction of the values' own sum of squares a residual is rounding.
constexpr double rounding_level = 1e-9;

/// Bits of theta that Brent's method finds: at a minimum, half of a double's.
constexpr int refined_bits = 24;

struct Candidate {
    double theta_rad = 0.0;
    double square_sum = std::numeric_limits<double>::infinity();
};

double own_square_sum(std::span<const PhaseSamples> flights) {
    double sum = 0.0;
    for (const auto& flight : flights) sum += as_vector(flight.power_w).squaredNorm();
    return sum;
}

Candidate refined(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range, double theta_rad,
                  double reach_rad) {
    const double low = std::max(range.low_rad, theta_rad - reach_rad);
    const double high = std::min(range.high_rad, theta_rad + reach_rad);
    const auto square_sum = [&](double theta) { return projected_square_sum(flights, order, theta); };
    const auto [at_rad, value] = boost::math::tools::brent_find_minima(square_sum, low, high, refined_bits);
    return {at_rad, value};
}

/// The scan's local minima, its ends included, lowest first.
std::vector<Candidate> minima(const FrequencyScan& scan) {
    std::vector<Candidate> found;
    const auto& sums = scan.square_sum;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool falls = i == 0 || sums[i] <= sums[i - 1];
        const bool rises = i + 1 == sums.size() || sums[i] < sums[i + 1];
        if (falls && rises) found.push_back({scan.grid.theta_rad(i), sums[i]});
    }
    std::ranges::sort(found, {}, &Candidate::square_sum);
    return found;
}

/// The scan's least value between two thetas.
double least_between(const FrequencyScan& scan, double low_rad, double high_rad) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i)
        if (const double theta_rad = scan.grid.theta_rad(i); theta_rad >= low_rad && theta_rad <= high_rad)
            least = std::min(least, scan.square_sum[i]);
    return least;
}

}  // namespace

ScanGrid scan_grid(const FrequencyRange& range, int order) {
    const double step_rad = range.high_rad / std::ceil(range.high_rad * order / turn_between_rad);
    return {order, step_rad, static_cast<std::size_t>(std::ceil(range.low_rad / step_rad)),
            static_cast<std::size_t>(std::round(range.high_rad / step_rad))};
}

FrequencyScan scan_flight(const PhaseSamples& samples, int order, const FrequencyRange& range) {
    const auto grid = scan_grid(range, order);
    if (samples.scan && samples.scan->grid == grid) return *samples.scan;
    FrequencyScan scan{grid, std::vector<double>(grid.size(), own_square_sum(std::span(&samples, 1)))};
    const auto sums = sum_by_fft(samples, grid.step_rad, 2 * static_cast<std::size_t>(order) * grid.last + 1);
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i)
        scan.square_sum[i] -= explained_square_sum(sums, grid.first + i, order);
    return scan;
}

FrequencyScan scan_frequencies(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range) {
    const auto grid = scan_grid(range, order);
    FrequencyScan scan{grid, std::vector<double>(grid.size(), 0.0)};
    // A block at a time, because those of thousands of flights would fill the memory.
    constexpr std::size_t block = 64;
    for (std::size_t begin = 0; begin < flights.size(); begin += block) {
        const auto some = flights.subspan(begin, std::min(block, flights.size() - begin));
        std::vector<FrequencyScan> made(some.size());
        for_each_in_parallel(some.size(), [&](std::size_t i) { made[i] = scan_flight(some[i], order, range); });
        for (const auto& flight : made)
            for (std::size_t i = 0; i < scan.square_sum.size(); ++i) scan.square_sum[i] += flight.square_sum[i];
    }
    return scan;
}

double find_frequency(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                      const FrequencyScan& scan) {
    auto candidates = minima(scan);
    candidates.resize(std::min(candidates.size(), refined_minima));
    const double total = own_square_sum(flights);
    Candidate best;
    for (const auto& candidate : candidates) {
        if (total - candidate.square_sum < candidate_fraction * (total - best.square_sum)) break;
        const auto fine = refined(flights, order, range, candidate.theta_rad, scan.grid.step_rad);
        if (fine.square_sum < best.square_sum) best = fine;
    }
    return resolve_subharmonic(flights, order, range, scan, best.theta_rad);
}

double resolve_subharmonic(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range,
                           const FrequencyScan& scan, double theta_rad) {
    const double total = own_square_sum(flights);
    const double rounding = std::max(rounding_level * total, std::numeric_limits<double>::min());
    const double best = std::max(rounding, projected_square_sum(flights, order, theta_rad));
    double degrees_of_freedom = -1.0;
    for (const auto& flight : flights) {
        degrees_of_freedom += static_cast<double>(flight.tau.size()) - coefficient_count(order);
    }
    degrees_of_freedom = std::max(1.0, degrees_of_freedom);
    const double variance = best / degrees_of_freedom;
    for (int multiple = order; multiple >= 2; --multiple) {
        const double reach_rad = turn_between_rad / order * multiple;
        if (multiple * theta_rad + reach_rad > range.high_rad) continue;
        const int lost_harmonics = order - order / multiple;
        const double lacking = 2.0 * static_cast<double>(flights.size()) * lost_harmonics;
        const boost::math::fisher_f distribution(lacking, degrees_of_freedom);
        const double by_chance =
            lacking * variance * boost::math::quantile(boost::math::complement(distribution, harmonic_significance));
        const double explained = total - best;
        const double max_worse = std::min(by_chance, lacking * variance + negligible_fraction * explained);
        const double least =
            least_between(scan, multiple * theta_rad - reach_rad, multiple * theta_rad + reach_rad) - best;
        if (least > max_worse + lost_between_fraction * explained) continue;
        const auto simpler = refined(flights, order, range, multiple * theta_rad, reach_rad);
        const bool slope = std::abs(simpler.theta_rad - multiple * theta_rad) > 0.9 * reach_rad;
        if (slope) continue;  // the least is where the search ended, not a minimum
        if (std::max(rounding, simpler.square_sum) - best <= max_worse) return simpler.theta_rad;
    }
    return theta_rad;
}

JointFit fit_at_frequency(std::span<const PhaseSamples> flights, int order, double theta_rad) {
    JointFit result;
    result.theta_rad = theta_rad;
    for (const auto& flight : flights) {
        auto fit = solve_least_squares(fourier_basis(flight.tau, order, theta_rad), as_vector(flight.power_w));
        if (!fit)
            throw NoResultError(
                fmt::format("flight '{}': the times of its {} samples do not determine a series of "
                            "order {} at omega * duration = {:.4g} rad",
                            flight.flight, flight.tau.size(), order, theta_rad));
        result.coefficients.push_back(std::move(fit->coefficients));
        result.square_sum.push_back(fit->residual_square_sum);
    }
    return result;
}

}  // namespace flightwatt::mechanical
