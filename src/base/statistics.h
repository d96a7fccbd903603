#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// The statistics of samples and of the normal and Student's t distribution, for every module.
namespace flightwatt {

/// Confidence level of all intervals that FlightWatt reports.
inline constexpr double confidence_level = 0.95;

/// From `low` to `high`; of an estimate at that level.
struct Interval {
    double low = 0.0;
    double high = 0.0;
    bool contains(double value) const { return low <= value && value <= high; }
    bool operator==(const Interval&) const = default;
};

/// Arithmetic mean. `values` must not be empty.
double mean(std::span<const double> values);

/// Sample variance and standard deviation (n - 1) of 2 values or more.
double sample_variance(std::span<const double> values);
double sample_sd(std::span<const double> values);

/// Of an even number of values, the mean of the two middle ones. `values` must not be empty.
double median(std::vector<double> values);

/// Of an even number of values, the larger of the two middle ones: one that was measured. Not empty.
double median_high(std::vector<double> values);

/// Quantile of values in ascending order, straight lines between them (Hyndman and Fan's type 7). `sorted`
/// must not be empty; `probability` from 0 to 1.
double quantile(std::span<const double> sorted, double probability);

/// Returns the same of values in any order.
double quantile_of(std::vector<double> values, double probability);

/// Quantile of the standard normal distribution; `probability` above 0 and below 1.
double normal_quantile(double probability);

/// Half width of an interval at `confidence_level`, in standard deviations of a normal error: 1.96.
double normal_half_width();

/// The same in standard errors, for Student's t; `degrees_of_freedom`, whole or not, count as at least one.
/// 12.7 for 1, 1.96 for many.
double student_t_half_width(double degrees_of_freedom, double probability = confidence_level);

/// For cross-validation: which of `count` things are left out together. Each alone, or, of more than `most`, in so many
/// groups of almost equal size in which no two neighbours are. Within a group they rise.
std::vector<std::vector<std::size_t>> make_folds(std::size_t count, std::size_t most);

}  // namespace flightwatt
