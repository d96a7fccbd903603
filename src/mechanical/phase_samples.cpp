#include "mechanical/phase_samples.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::mechanical {
namespace {

constexpr std::size_t compared_samples = 8;
constexpr std::size_t min_compared = 5;
constexpr double edge_gaps = 2.0;
constexpr double max_edge_fraction = 0.1;  ///< of the phase's samples
constexpr double standard_errors = 6.0;
constexpr double min_jump_fraction = 0.1;

/// Samples of the phase at one edge, from it inwards (`inwards`: 1 or -1), whose power is the neighbour's. `first` and
/// `last` (behind it) are the phase's samples.
std::size_t count_at(const flight::Track& power, const flight::PhaseEdge& edge, std::ptrdiff_t first,
                     std::ptrdiff_t last, std::ptrdiff_t inwards) {
    std::vector<double> gaps;
    for (auto i = static_cast<std::size_t>(first); i + 1 < static_cast<std::size_t>(last); ++i)
        gaps.push_back(power.time_s[i + 1] - power.time_s[i]);
    const double step_s = gaps.empty() ? 0.0 : median(std::move(gaps));
    const double reach_s = edge.gap_s + edge_gaps * step_s;
    const double max_s = reach_s + 2.0 * static_cast<double>(compared_samples) * step_s;
    const auto max = static_cast<std::size_t>(max_edge_fraction * static_cast<double>(last - first));
    std::vector<double> near_w;   // of the phase
    std::vector<double> own_w;    // of the phase, behind them
    std::vector<double> other_w;  // of the neighbour, outwards: not those that may be of this phase, none behind a gap
    const auto begin = inwards > 0 ? first : last - 1;
    const auto off_s = [&](std::ptrdiff_t i) {
        return std::abs(power.time_s[static_cast<std::size_t>(i)] - edge.time_s);
    };
    const auto value = [&](std::ptrdiff_t i) { return power.value[static_cast<std::size_t>(i)]; };
    const auto exists = [&](std::ptrdiff_t i) { return i >= 0 && i < std::ssize(power.time_s); };
    auto i = begin;
    for (; exists(i) && off_s(i) <= reach_s && near_w.size() < max; i += inwards) near_w.push_back(value(i));
    for (; exists(i) && own_w.size() < compared_samples; i += inwards) own_w.push_back(value(i));
    for (i = begin - inwards; exists(i) && off_s(i) <= max_s && other_w.size() < compared_samples; i -= inwards)
        if (off_s(i) > reach_s) other_w.push_back(value(i));
    if (own_w.size() < min_compared || other_w.size() < min_compared) return 0;
    const double mean_w = mean(own_w);
    const double own_error_w = standard_errors * sample_sd(own_w);
    const double jump_w = mean(other_w) - mean_w;
    if (std::abs(jump_w) <= own_error_w + standard_errors * sample_sd(other_w)) return 0;
    // Those beyond the middle of the jump, and the next one if it is in the jump.
    std::size_t count = 0;
    for (std::size_t k = 0; k < near_w.size(); ++k)
        if ((near_w[k] - mean_w) / jump_w > 0.5) count = k + 1;
    if (count == near_w.size()) return count;
    const double off_w = near_w[count] - mean_w;
    return count + (off_w / jump_w > min_jump_fraction && std::abs(off_w) > own_error_w ? 1 : 0);
}

}  // namespace

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
        const auto [min_w, max_w] = std::ranges::minmax(samples.power_w);
        return max_w - min_w <= rounding * std::max(std::abs(min_w), std::abs(max_w));
    });
}

double median_gap(const std::vector<double>& tau) {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < tau.size(); ++i)
        if (tau[i] > tau[i - 1]) gaps.push_back(tau[i] - tau[i - 1]);
    return gaps.empty() ? 0.0 : median(std::move(gaps));
}

EdgeSamples count_neighbour_samples(const flight::Track& power, const flight::PhaseSpan& span) {
    const auto first = static_cast<std::ptrdiff_t>(flight::first_at_or_after(power.time_s, span.start.time_s));
    const auto last = static_cast<std::ptrdiff_t>(flight::first_after(power.time_s, span.end.time_s));
    if (last <= first) return {};
    return {count_at(power, span.start, first, last, 1), count_at(power, span.end, first, last, -1)};
}

}  // namespace flightwatt::mechanical
