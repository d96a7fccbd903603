#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt::flight {

/// The samples [first, last).
struct SampleRange {
    std::size_t first;
    std::size_t last;
    std::size_t size() const { return last - first; }
};

/// The runs of neighbouring samples of `within` for which joins(i) is true, where each also continues(i), which
/// compares it with the one before it. In order; none is empty.
template <typename Joins, typename Continues>
std::vector<SampleRange> runs_of(SampleRange within, const Joins& joins, const Continues& continues) {
    std::vector<SampleRange> runs;
    for (auto i = within.first; i < within.last; ++i) {
        if (!joins(i)) continue;
        if (runs.empty() || runs.back().last != i || !continues(i)) runs.push_back({i, i});
        runs.back().last = i + 1;
    }
    return runs;
}

template <typename Joins>
std::vector<SampleRange> runs_of(SampleRange within, const Joins& joins) {
    return runs_of(within, joins, [](std::size_t) { return true; });
}

/// How long it holds within a range [s], from sample to sample; gaps of more than `gap_s` do not count.
template <typename Holds>
double time_where(const std::vector<double>& time_s, SampleRange within, double gap_s, const Holds& holds) {
    double together_s = 0.0;
    for (auto i = within.first + 1; i < within.last; ++i)
        if (holds(i - 1) && holds(i) && time_s[i] - time_s[i - 1] <= gap_s) together_s += time_s[i] - time_s[i - 1];
    return together_s;
}

/// The runs of at least so many samples that repeat one value.
inline std::vector<SampleRange> runs_of_equal(const std::vector<double>& values, std::size_t min_samples) {
    auto runs = runs_of(
        {0, values.size()}, [](std::size_t) { return true; },
        [&](std::size_t i) { return values[i] == values[i - 1]; });
    std::erase_if(runs, [&](const SampleRange& run) { return run.size() < min_samples; });
    return runs;
}

}  // namespace flightwatt::flight
