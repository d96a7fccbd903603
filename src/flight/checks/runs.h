#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace flightwatt::flight {

/// The samples, or points of a grid, [begin, end).
struct IndexSpan {
    std::size_t begin;
    std::size_t end;
    std::size_t size() const { return end - begin; }
};

inline std::span<const double> part_of(const std::vector<double>& values, IndexSpan span) {
    return std::span(values).subspan(span.begin, span.size());
}

template <typename T>
void set_part(std::vector<T>& values, IndexSpan span, T value) {
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(span.begin),
              values.begin() + static_cast<std::ptrdiff_t>(span.end), value);
}

/// The runs of neighbouring samples of `within` for which joins(i) is true, where each also continues(i), which
/// compares it with the one before it. In order; none is empty.
template <typename Joins, typename Continues>
std::vector<IndexSpan> runs_of(IndexSpan within, const Joins& joins, const Continues& continues) {
    std::vector<IndexSpan> runs;
    for (auto i = within.begin; i < within.end; ++i) {
        if (!joins(i)) continue;
        if (runs.empty() || runs.back().end != i || !continues(i)) runs.push_back({i, i});
        runs.back().end = i + 1;
    }
    return runs;
}

template <typename Joins>
std::vector<IndexSpan> runs_of(IndexSpan within, const Joins& joins) {
    return runs_of(within, joins, [](std::size_t) { return true; });
}

/// How long it holds within a range [s], from sample to sample; gaps of more than `gap_s` do not count.
template <typename Holds>
double time_where(const std::vector<double>& time_s, IndexSpan within, double gap_s, const Holds& holds) {
    double together_s = 0.0;
    for (auto i = within.begin + 1; i < within.end; ++i)
        if (holds(i - 1) && holds(i) && time_s[i] - time_s[i - 1] <= gap_s) together_s += time_s[i] - time_s[i - 1];
    return together_s;
}

/// The runs of at least so many samples that repeat one value.
inline std::vector<IndexSpan> runs_of_equal(const std::vector<double>& values, std::size_t min_samples) {
    std::vector<IndexSpan> runs;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
        while (end < values.size() && values[end] == values[begin]) ++end;
        if (end - begin >= min_samples) runs.push_back({begin, end});
    }
    return runs;
}

}  // namespace flightwatt::flight
