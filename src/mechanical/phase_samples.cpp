#include "mechanical/phase_samples.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace flightwatt::mechanical {
namespace {

constexpr std::size_t compared_samples = 8;
constexpr std::size_t min_compared = 5;
constexpr double edge_gaps = 2.0;
constexpr double max_edge_fraction = 0.1;  ///< of the phase's samples
constexpr double standard_errors = 6.0;
constexpr double min_jump_fraction = 0.1;

/// The samples about one edge, those of the phase from the edge inwards.
struct EdgeView {
    std::vector<double> candidates_w;  ///< of the phase, near the edge
    std::vector<double> own_w;         ///< of the phase, behind them
    std::vector<double> other_w;       ///< of the neighbour, outwards
};

/// Candidates beyond the middle of a jump from the phase's power to the neighbour's, and the next one if it is in the
/// jump.
std::size_t count_of_neighbour(const EdgeView& view) {
    if (view.own_w.size() < min_compared || view.other_w.size() < min_compared) return 0;
    const double own_w = mean(view.own_w);
    const double own_error_w = standard_errors * sample_sd(view.own_w);
    const double jump_w = mean(view.other_w) - own_w;
    if (std::abs(jump_w) <= own_error_w + standard_errors * sample_sd(view.other_w)) return 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < view.candidates_w.size(); ++i)
        if ((view.candidates_w[i] - own_w) / jump_w > 0.5) count = i + 1;
    if (count == view.candidates_w.size()) return count;
    const double off_w = view.candidates_w[count] - own_w;
    const bool is_in_jump = off_w / jump_w > min_jump_fraction && std::abs(off_w) > own_error_w;
    return count + (is_in_jump ? 1 : 0);
}

/// Power of the track from `first` in steps of `step` (1 or -1), up to `max` samples whose times are `wanted`.
template <typename Wanted>
std::vector<double> take_samples(const flight::Track& track, std::ptrdiff_t first, std::ptrdiff_t step, std::size_t max,
                                 const Wanted& wanted) {
    std::vector<double> power_w;
    for (auto i = first; i >= 0 && i < std::ssize(track.time_s) && power_w.size() < max; i += step)
        if (wanted(track.time_s[static_cast<std::size_t>(i)]))
            power_w.push_back(track.value[static_cast<std::size_t>(i)]);
    return power_w;
}

double median_step_s(const flight::Track& power, std::ptrdiff_t first, std::ptrdiff_t last) {
    std::vector<double> gaps;
    for (auto i = first; i + 1 < last; ++i) {
        gaps.push_back(power.time_s[static_cast<std::size_t>(i) + 1] - power.time_s[static_cast<std::size_t>(i)]);
    }
    return gaps.empty() ? 0.0 : median(std::move(gaps));
}

std::size_t count_at(const flight::Track& power, const flight::PhaseEdge& edge, std::ptrdiff_t first,
                     std::ptrdiff_t last, bool at_start) {
    const double step_s = median_step_s(power, first, last);
    const double reach_s = edge.gap_s + edge_gaps * step_s;
    const std::ptrdiff_t inwards = at_start ? 1 : -1;
    const auto max = static_cast<std::size_t>(max_edge_fraction * static_cast<double>(last - first));
    EdgeView view;
    const auto near = [&](double time_s) { return std::abs(time_s - edge.time_s) <= reach_s; };
    const auto begin = at_start ? first : last - 1;
    view.candidates_w = take_samples(power, begin, inwards, max, near);
    view.own_w = take_samples(power, begin + inwards * std::ssize(view.candidates_w), inwards, compared_samples,
                              [](double) { return true; });
    // The neighbour's: not those that may be of this phase, and none behind a gap.
    const double max_s = reach_s + 2.0 * static_cast<double>(compared_samples) * step_s;
    view.other_w = take_samples(power, begin - inwards, -inwards, compared_samples, [&](double time_s) {
        return !near(time_s) && std::abs(time_s - edge.time_s) <= max_s;
    });
    return count_of_neighbour(view);
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

double median_gap(std::vector<double> tau) {
    std::sort(tau.begin(), tau.end());
    std::vector<double> gaps;
    for (std::size_t i = 1; i < tau.size(); ++i)
        if (tau[i] > tau[i - 1]) gaps.push_back(tau[i] - tau[i - 1]);
    return gaps.empty() ? 0.0 : median(std::move(gaps));
}

PhaseSamples sort_by_time(const PhaseSamples& samples) {
    std::vector<std::size_t> order(samples.tau.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return samples.tau[i]; });
    auto sorted = samples;
    for (std::size_t i = 0; i < order.size(); ++i) {
        sorted.tau[i] = samples.tau[order[i]];
        sorted.power_w[i] = samples.power_w[order[i]];
    }
    return sorted;
}

EdgeSamples count_neighbour_samples(const flight::Track& power, const flight::PhaseSpan& span) {
    const auto begin = power.time_s.begin();
    const auto first = std::ranges::lower_bound(power.time_s, span.start.time_s) - begin;
    const auto last = std::ranges::upper_bound(power.time_s, span.end.time_s) - begin;
    if (last <= first) return {};
    return {count_at(power, span.start, first, last, true), count_at(power, span.end, first, last, false)};
}

}  // namespace flightwatt::mechanical
