#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace flightwatt::batch {

/// A quantity of one flight, and when it was flown.
struct DatedValue {
    double day = 0.0;  ///< days since any time, with fractions
    double value = 0.0;
};

/// How a quantity goes over the dates of flights: the Theil-Sen slope, which a few odd flights do not move.
struct Trend {
    std::size_t flights = 0;
    double median = 0.0;  ///< of the values
    double per_day = 0.0;
    double low_per_day = 0.0;  ///< interval of 95 % or, as few flights have few orders, a little more
    double high_per_day = 0.0;
};

/// Whether the interval excludes no change at all.
inline bool is_significant(const Trend& trend) { return trend.low_per_day > 0.0 || trend.high_per_day < 0.0; }

/// The same in percent of the values' median: what is left of it where all values may be wrong by one factor.
/// std::nullopt where the median is not above 0.
std::optional<Trend> relative_trend(const Trend& trend);

/// A trend, or why there is none.
struct TrendResult {
    std::optional<Trend> trend;
    std::string no_trend_reason;  ///< "3 flights, expected 5 or more"; empty with a trend
};

/// Of fewer flights no order of their values is as rare as one in 20.
inline constexpr std::size_t min_trend_flights = 5;
/// Flights of a day have their weather in common: those of two days tell these apart and no more.
inline constexpr std::size_t min_trend_days = 3;

/// The median of the slopes between all pairs of flights, with the interval that inverts Kendall's test (P. K. Sen,
/// 1968, Journal of the American Statistical Association 63): by the exact distribution of the orders, or by its normal
/// approximation for more than 50 flights and for flights at one time. Assumes nothing of how the values scatter, but
/// that they do so independently. In any order; the work grows with their square.
TrendResult estimate_trend(std::span<const DatedValue> values);

}  // namespace flightwatt::batch
