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

constexpr std::size_t samples_of_line = 8;
constexpr std::size_t min_of_line = 5;
constexpr double gaps_looked_at = 2.0;
constexpr double part_looked_at = 0.1;  ///< of the phase's samples
constexpr double standard_errors = 6.0;
constexpr double part_of_jump = 0.1;

/// A straight line through power samples, and how well it tells one more.
struct PowerLine {
    double time_s = 0.0;  ///< mean
    double power_w = 0.0;
    double slope_w_per_s = 0.0;
    double square_time = 0.0;  ///< sum of squares about the mean
    double sd_w = 0.0;
    double samples = 0.0;

    double at(double when_s) const { return power_w + slope_w_per_s * (when_s - time_s); }
    double error_w(double when_s) const {
        return sd_w * std::sqrt(1.0 + 1.0 / samples + std::pow(when_s - time_s, 2) / square_time);
    }
};

std::optional<PowerLine> line_through(std::span<const double> time_s, std::span<const double> power_w) {
    if (time_s.size() < min_of_line) return std::nullopt;
    PowerLine line{mean(time_s), mean(power_w)};
    line.samples = static_cast<double>(time_s.size());
    double product = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        line.square_time += std::pow(time_s[i] - line.time_s, 2);
        product += (time_s[i] - line.time_s) * power_w[i];
    }
    if (line.square_time <= 0.0) return std::nullopt;
    line.slope_w_per_s = product / line.square_time;
    double square_sum = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) square_sum += std::pow(power_w[i] - line.at(time_s[i]), 2);
    line.sd_w = std::sqrt(square_sum / (line.samples - 2.0));
    return line;
}

/// The samples about one edge, those of the phase from the edge inwards.
struct EdgeView {
    std::vector<double> time_s;  ///< of the phase, `looked_at` of them and those of its line behind
    std::vector<double> power_w;
    std::size_t looked_at = 0;
    std::vector<double> other_time_s;  ///< of the neighbour, beyond as much time
    std::vector<double> other_power_w;
};

std::size_t count_of_neighbour(const EdgeView& view) {
    if (view.time_s.size() < view.looked_at) return 0;
    const auto own =
        line_through(std::span(view.time_s).subspan(view.looked_at), std::span(view.power_w).subspan(view.looked_at));
    const auto other = line_through(view.other_time_s, view.other_power_w);
    if (!own || !other) return 0;
    std::size_t count = 0;
    std::size_t place = 0;
    for (; place < view.looked_at; ++place) {
        const double when_s = view.time_s[place];
        const double jump_w = other->at(when_s) - own->at(when_s);
        const double off_w = view.power_w[place] - own->at(when_s);
        const bool apart = std::abs(jump_w) > standard_errors * (own->error_w(when_s) + other->error_w(when_s));
        if (apart && std::abs(off_w) > std::abs(view.power_w[place] - other->at(when_s))) count = place + 1;
    }
    if (count == view.looked_at) return count;
    const double when_s = view.time_s[count];
    const double jump_w = other->at(when_s) - own->at(when_s);
    const double off_w = view.power_w[count] - own->at(when_s);
    const bool apart = std::abs(jump_w) > standard_errors * (own->error_w(when_s) + other->error_w(when_s));
    const bool on_the_way = off_w * jump_w > 0.0 && std::abs(off_w) > part_of_jump * std::abs(jump_w) &&
                            std::abs(off_w) > standard_errors * own->error_w(when_s);
    return count + (apart && on_the_way ? 1 : 0);
}

/// Of the track from `first` in steps of `step` (1 or -1), as many as `most` while `wanted` says so of their times.
template <typename Wanted>
void take_samples(const flight::Track& track, std::ptrdiff_t first, std::ptrdiff_t step, std::size_t most,
                  const Wanted& wanted, std::vector<double>& time_s, std::vector<double>& power_w) {
    const auto size = static_cast<std::ptrdiff_t>(track.time_s.size());
    for (auto i = first; i >= 0 && i < size && time_s.size() < most; i += step) {
        const auto place = static_cast<std::size_t>(i);
        if (!wanted(track.time_s[place])) continue;
        time_s.push_back(track.time_s[place]);
        power_w.push_back(track.value[place]);
    }
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
    const double reach_s = edge.gap_s + gaps_looked_at * step_s;
    const std::ptrdiff_t inwards = at_start ? 1 : -1;
    const auto most = static_cast<std::size_t>(part_looked_at * static_cast<double>(last - first));
    EdgeView view;
    const auto near = [&](double time_s) { return std::abs(time_s - edge.time_s) <= reach_s; };
    const auto begin = at_start ? first : last - 1;
    take_samples(power, begin, inwards, most, near, view.time_s, view.power_w);
    view.looked_at = view.time_s.size();
    if (view.looked_at == 0) return 0;
    take_samples(
        power, begin + inwards * static_cast<std::ptrdiff_t>(view.looked_at), inwards, view.looked_at + samples_of_line,
        [](double) { return true; }, view.time_s, view.power_w);
    // The neighbour's: not those that may be of this phase, and not what lies behind a gap.
    const double max_s = reach_s + 2.0 * static_cast<double>(samples_of_line) * step_s;
    take_samples(
        power, begin - inwards, -inwards, samples_of_line,
        [&](double time_s) { return !near(time_s) && std::abs(time_s - edge.time_s) <= max_s; }, view.other_time_s,
        view.other_power_w);
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
        const auto [least, most] = std::ranges::minmax(samples.power_w);
        return most - least <= rounding * std::max(std::abs(least), std::abs(most));
    });
}

double median_gap(std::vector<double> tau) {
    std::sort(tau.begin(), tau.end());
    std::vector<double> gaps;
    for (std::size_t i = 1; i < tau.size(); ++i)
        if (tau[i] > tau[i - 1]) gaps.push_back(tau[i] - tau[i - 1]);
    return gaps.empty() ? 0.0 : median(std::move(gaps));
}

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

EdgeSamples count_neighbour_samples(const flight::Track& power, const flight::PhaseSpan& span) {
    const auto begin = power.time_s.begin();
    const auto first = std::ranges::lower_bound(power.time_s, span.start.time_s) - begin;
    const auto last = std::ranges::upper_bound(power.time_s, span.end.time_s) - begin;
    if (last <= first) return {};
    return {count_at(power, span.start, first, last, true), count_at(power, span.end, first, last, false)};
}

}  // namespace flightwatt::mechanical
