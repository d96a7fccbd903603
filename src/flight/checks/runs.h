#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flightwatt::flight {

/// Indices [begin, end) of samples, or of points of a grid.
struct IndexSpan {
    std::size_t begin;
    std::size_t end;
    std::size_t size() const { return end - begin; }
};

/// Returns the values of a span.
inline std::span<const double> part_of(const std::vector<double>& values, IndexSpan span) {
    return std::span(values).subspan(span.begin, span.size());
}

/// Sets the values of a span.
template <typename T>
void set_part(std::vector<T>& values, IndexSpan span, T value) {
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(span.begin),
              values.begin() + static_cast<std::ptrdiff_t>(span.end), value);
}

/// Returns the runs of consecutive samples of `within` for which joins(i) is true, in order; none is empty. A run ends
/// before a sample for which continues(i), which compares it with the one before, is false.
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

/// Returns the runs of consecutive samples of `within` for which joins(i) is true, in order; none is empty.
template <typename Joins>
std::vector<IndexSpan> runs_of(IndexSpan within, const Joins& joins) {
    return runs_of(within, joins, [](std::size_t) { return true; });
}

/// Returns the time in a span between samples for both of which holds(i) is true [s], without gaps of more than
/// `gap_s`.
template <typename Holds>
double time_where(const std::vector<double>& time_s, IndexSpan within, double gap_s, const Holds& holds) {
    double together_s = 0.0;
    for (auto i = within.begin + 1; i < within.end; ++i)
        if (holds(i - 1) && holds(i) && time_s[i] - time_s[i - 1] <= gap_s) together_s += time_s[i] - time_s[i - 1];
    return together_s;
}

/// Returns the runs of at least `min_samples` equal values.
inline std::vector<IndexSpan> runs_of_equal(const std::vector<double>& values, std::size_t min_samples) {
    std::vector<IndexSpan> runs;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
        while (end < values.size() && values[end] == values[begin]) ++end;
        if (end - begin >= min_samples) runs.push_back({begin, end});
    }
    return runs;
}

/// Returns the median of the `Width` (odd) values around each: it removes spikes of less than half that width and keeps
/// ramps. The values of the first and last half width are unchanged.
template <std::size_t Width>
std::vector<double> running_median(const std::vector<double>& values) {
    constexpr auto reach = static_cast<std::ptrdiff_t>(Width / 2);
    std::vector<double> smooth = values;
    for (std::ptrdiff_t i = reach; i + reach < static_cast<std::ptrdiff_t>(values.size()); ++i) {
        std::array<double, Width> near{};
        std::copy_n(values.begin() + i - reach, Width, near.begin());
        std::nth_element(near.begin(), near.begin() + reach, near.end());
        smooth[static_cast<std::size_t>(i)] = near[Width / 2];
    }
    return smooth;
}

}  // namespace flightwatt::flight
