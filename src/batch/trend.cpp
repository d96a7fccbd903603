#include "batch/trend.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

constexpr std::size_t max_exact = 50;
constexpr double tail = (1.0 - confidence_level) / 2.0;

/// The greatest k such that fewer than k inversions of a random order of n values have a probability of at most `tail`.
std::size_t rare_inversions(std::size_t n) {
    std::vector<double> probability{1.0};  // by the number of inversions
    for (std::size_t i = 2; i <= n; ++i) {
        std::vector<double> next(probability.size() + i - 1, 0.0);
        for (std::size_t k = 0; k < probability.size(); ++k)
            for (std::size_t more = 0; more < i; ++more) next[k + more] += probability[k] / static_cast<double>(i);
        probability = std::move(next);
    }
    double below = 0.0;
    std::size_t k = 0;
    while (k < probability.size() && below + probability[k] <= tail) below += probability[k++];
    return k;
}

/// Number of slopes below the interval, and above it.
std::size_t outside(std::span<const DatedValue> values, std::size_t pairs) {
    std::map<double, std::size_t> at_one_time;
    for (const auto& value : values) ++at_one_time[value.day];
    const auto n = values.size();
    if (at_one_time.size() == n && n <= max_exact) return rare_inversions(n);
    const auto term = [](std::size_t count) {
        const auto c = static_cast<double>(count);
        return c * (c - 1.0) * (2.0 * c + 5.0);
    };
    double variance = term(n);
    for (const auto& [day, count] : at_one_time) variance -= term(count);
    constexpr double kendall = 18.0;
    const double half = normal_half_width() * std::sqrt(variance / kendall);
    return static_cast<std::size_t>(std::max(0.0, std::floor((static_cast<double>(pairs) - half) / 2.0)));
}

}  // namespace

TrendResult estimate_trend(std::span<const DatedValue> values) {
    if (values.size() < min_trend_flights)
        return {{},
                fmt::format("{} flight{}, expected {} or more", values.size(), values.size() == 1 ? "" : "s",
                            min_trend_flights)};
    std::set<double> days;
    for (const auto& value : values) days.insert(std::floor(value.day));
    if (days.size() < min_trend_days) {
        return {{},
                fmt::format("all {} flights are of {}, expected {} days or more", values.size(),
                            days.size() == 1 ? "one day" : "two days", min_trend_days)};
    }
    std::vector<double> slopes;
    slopes.reserve(values.size() * (values.size() - 1) / 2);
    std::vector<double> all;
    for (std::size_t i = 0; i < values.size(); ++i) {
        all.push_back(values[i].value);
        for (std::size_t j = 0; j < i; ++j) {
            const double apart = values[i].day - values[j].day;
            if (apart != 0.0) slopes.push_back((values[i].value - values[j].value) / apart);
        }
    }
    const auto out = outside(values, slopes.size());
    if (out == 0) return {{}, fmt::format("{} flights at too few times", values.size())};
    std::ranges::sort(slopes);
    return {Trend{values.size(), median(std::move(all)), median(slopes), slopes[out - 1], slopes[slopes.size() - out]},
            ""};
}

}  // namespace flightwatt::batch
