#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace flightwatt::batch {

/// A quantity of one flight and its date.
struct DatedValue {
    double day = 0.0;  ///< days since any time, with fractions
    double value = 0.0;
};

/// Theil-Sen slope of a quantity over the dates of flights; robust against outliers.
struct Trend {
    std::size_t flights = 0;
    double median = 0.0;  ///< of the values
    double per_day = 0.0;
    double low_per_day = 0.0;  ///< 95 % interval, or slightly wider for few flights
    double high_per_day = 0.0;
};

/// Whether the interval excludes 0.
inline bool is_significant(const Trend& trend) { return trend.low_per_day > 0.0 || trend.high_per_day < 0.0; }

/// A trend, or the reason without one.
struct TrendResult {
    std::optional<Trend> trend;
    std::string no_trend_reason;  ///< "3 flights, expected 5 or more"; empty with a trend
};

/// With fewer flights no order has a probability below 1/20.
inline constexpr std::size_t min_trend_flights = 5;
/// Flights of one day share the weather.
inline constexpr std::size_t min_trend_days = 3;

/// The median of the slopes between all pairs of flights, with the interval that inverts Kendall's test (P. K. Sen,
/// 1968, Journal of the American Statistical Association 63): exact, or by the normal approximation for more than 50
/// flights and for equal times. Assumes independent values of any distribution. Quadratic in their number.
TrendResult estimate_trend(std::span<const DatedValue> values);

}  // namespace flightwatt::batch
