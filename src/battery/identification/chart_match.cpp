#include "battery/identification/chart_match.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <boost/math/tools/toms748_solve.hpp>

namespace flightwatt::battery {
namespace {

constexpr std::array chart_soc_percent{0.0,  5.0,  10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0,
                                       55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 90.0, 95.0, 100.0};

/// Prior probability of a chemistry (our estimate), and its voltage at these states of charge.
struct Chart {
    double probability;
    std::array<double, chart_soc_percent.size()> cell_v;
};

/// In the order of Chemistry.
constexpr std::array charts{Chart{0.75, {3.27, 3.61, 3.69, 3.71, 3.73, 3.75, 3.77, 3.79, 3.80, 3.82, 3.84,
                                         3.85, 3.87, 3.91, 3.95, 3.98, 4.02, 4.08, 4.11, 4.15, 4.20}},
                            Chart{0.15, {2.80, 3.20, 3.36, 3.46, 3.51, 3.55, 3.58, 3.61, 3.64, 3.67, 3.71,
                                         3.75, 3.80, 3.86, 3.91, 3.96, 4.01, 4.05, 4.09, 4.13, 4.19}},
                            Chart{0.10, {3.30, 3.63, 3.69, 3.72, 3.75, 3.77, 3.79, 3.81, 3.84, 3.87, 3.90,
                                         3.94, 3.98, 4.02, 4.06, 4.11, 4.15, 4.20, 4.25, 4.30, 4.35}}};
constexpr int capacities_tried = 120;
constexpr double missing_step = 0.0125;
constexpr double full_step = 0.005;
constexpr double max_times_shown = 50.0;
constexpr double max_missing_fraction = 0.9;
constexpr double full_probability = 0.5;
constexpr double full_sd = 0.03;          // of the capacity
constexpr double resting_sd_v = 0.02;     // a cell, at rest
constexpr Eigen::Index max_compared = 4;  // points of the curve, evenly spread
constexpr double loaded_sd_v = 0.03;      // a cell, of slow relaxation under load
constexpr double rounding_percent = 0.01;
constexpr double max_beyond_percent = 10.0;

/// The points that are compared with a chart: the rest first, then the curve.
struct Compared {
    Eigen::VectorXd charge_ah;
    Eigen::VectorXd cell_v;
    Eigen::MatrixXd covariance_v2;  ///< a cell, without the chart's error
};

Compared compared(const ObservedOcv& shown) {
    const auto knots = static_cast<Eigen::Index>(shown.charge_ah.size());
    const auto points = std::min<Eigen::Index>(knots, max_compared);
    Eigen::MatrixXd between = Eigen::MatrixXd::Zero(points, knots);
    Compared all;
    all.charge_ah.resize(points + 1);
    all.charge_ah[0] = shown.resting_charge_ah;
    for (Eigen::Index p = 0; p < points; ++p) {
        const double position = static_cast<double>(p) / static_cast<double>(points - 1);
        all.charge_ah[p + 1] = std::lerp(shown.charge_ah.front(), shown.charge_ah.back(), position);
        const auto [lower, fraction] = find_knot_interval(shown.charge_ah, all.charge_ah[p + 1]);
        between(p, static_cast<Eigen::Index>(lower)) = 1.0 - fraction;
        between(p, static_cast<Eigen::Index>(lower) + 1) = fraction;
    }
    all.cell_v.resize(points + 1);
    all.cell_v << shown.resting_voltage_v / shown.cells,
        between * Eigen::Map<const Eigen::VectorXd>(shown.voltage_v.data(), knots) / shown.cells;
    all.covariance_v2 = Eigen::MatrixXd::Zero(points + 1, points + 1);
    all.covariance_v2(0, 0) = resting_sd_v * resting_sd_v;
    all.covariance_v2.bottomRightCorner(points, points) =
        between * shown.covariance_v2 * between.transpose() / (shown.cells * shown.cells) +
        Eigen::MatrixXd::Constant(points, points, loaded_sd_v * loaded_sd_v);
    all.covariance_v2.diagonal().array() += chart_local_sd_v * chart_local_sd_v;
    return all;
}

/// A missing fraction of the capacity, with its prior probability.
struct MissingFraction {
    double fraction = 0.0;
    double probability = 0.0;
    bool is_full = false;
};

std::vector<MissingFraction> missing_fractions() {
    std::vector<MissingFraction> parts;
    double sum = 0.0;
    for (int i = 0; full_step * i <= 3.0 * full_sd; ++i) {
        const double part = full_step * i;
        const double density = (i == 0 ? 0.5 : 1.0) * std::exp(-part * part / (2.0 * full_sd * full_sd));
        parts.push_back({part, density, true});
        sum += density;
    }
    for (auto& full : parts) full.probability *= full_probability / sum;
    const auto cells = static_cast<int>(std::lround(max_missing_fraction / missing_step));
    for (int i = 0; i < cells; ++i)
        parts.push_back({missing_step * (i + 0.5), (1.0 - full_probability) / cells, false});
    return parts;
}

struct ChartPoint {
    double soc_percent = 0.0;
    double slope_v_per_percent = 0.0;
};

ChartPoint chart_point(Chemistry chemistry, double soc_percent) {
    const double low = std::clamp(soc_percent - chart_soc_sd_percent, 0.0, units::percent_per_whole - 1.0);
    const double high = std::clamp(soc_percent + chart_soc_sd_percent, 1.0, units::percent_per_whole);
    return {soc_percent, (chart_voltage_v(chemistry, high) - chart_voltage_v(chemistry, low)) / (high - low)};
}

/// Covariance of a cell's deviations from its chart at two points.
double chart_covariance_v2(const ChartPoint& a, const ChartPoint& b) {
    const double apart = (a.soc_percent - b.soc_percent) / chart_correlation_percent;
    const double variance_v2 = chart_sd_v * chart_sd_v + a.slope_v_per_percent * b.slope_v_per_percent *
                                                             chart_soc_sd_percent * chart_soc_sd_percent;
    return variance_v2 * std::exp(-apart * apart / 2.0);
}

/// The logarithm of a likelihood; -infinity where the charge drawn exceeds the capacity by more than `beyond_percent`.
double log_likelihood(const Compared& shown, Chemistry chemistry, double capacity_ah, double missing_ah,
                      double beyond_percent) {
    const Eigen::VectorXd soc = (1.0 - (shown.charge_ah.array() + missing_ah) / capacity_ah) * units::percent_per_whole;
    if (soc.minCoeff() < -beyond_percent) return -std::numeric_limits<double>::infinity();
    const auto n = soc.size();
    Eigen::VectorXd difference(n);
    std::vector<ChartPoint> points;
    for (Eigen::Index i = 0; i < n; ++i) {
        difference[i] = shown.cell_v[i] - chart_voltage_v(chemistry, soc[i]);
        points.push_back(chart_point(chemistry, soc[i]));
    }
    Eigen::MatrixXd covariance = shown.covariance_v2;
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            covariance(i, j) +=
                chart_covariance_v2(points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(j)]);
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    const Eigen::VectorXd whitened = root.matrixL().solve(difference);
    return -0.5 * whitened.squaredNorm() - root.matrixLLT().diagonal().array().log().sum();
}

std::vector<double> capacities(const ObservedOcv& shown, std::optional<double> given_ah) {
    if (given_ah) return {*given_ah};
    std::vector<double> tried;
    tried.reserve(capacities_tried);
    for (int i = 0; i < capacities_tried; ++i)
        tried.push_back(shown.charge_ah.back() *
                        std::pow(max_times_shown, static_cast<double>(i) / (capacities_tried - 1)));
    return tried;
}

/// Quantile of (value, weight) pairs; weights sum to 1.
double weighted_quantile(std::vector<std::pair<double, double>> values, double probability) {
    std::ranges::sort(values);
    double below = 0.0;
    for (const auto& [value, weight] : values) {
        below += weight;
        if (below >= probability) return value;
    }
    return values.back().first;
}

}  // namespace

double chart_voltage_v(Chemistry chemistry, double soc_percent) {
    return interpolate_clamped(chart_soc_percent, charts.at(static_cast<std::size_t>(chemistry)).cell_v, soc_percent);
}

double extrapolation_sd_v(Chemistry chemistry, double soc_percent, double known_percent) {
    const auto there = chart_point(chemistry, soc_percent);
    const auto known = chart_point(chemistry, known_percent);
    const double variance_v2 =
        chart_covariance_v2(there, there) + chart_covariance_v2(known, known) - 2.0 * chart_covariance_v2(there, known);
    return std::sqrt(std::max(0.0, variance_v2) + chart_local_sd_v * chart_local_sd_v);
}

std::vector<CapacityHypothesis> capacity_posterior(const ObservedOcv& shown, std::optional<double> given_ah) {
    const auto all = compared(shown);
    // A given capacity is valid, though inexact initial charges may add up to more.
    const double beyond_percent = given_ah ? max_beyond_percent : rounding_percent;
    std::vector<CapacityHypothesis> posterior;
    double most = -std::numeric_limits<double>::infinity();
    const auto parts = missing_fractions();
    const auto add = [&](std::size_t chart, double capacity_ah, const MissingFraction& missing) {
        const auto chemistry = static_cast<Chemistry>(chart);
        if (chemistry != Chemistry::high_voltage && all.cell_v[0] > max_charged_cell_v) return;
        const double missing_ah = missing.fraction * capacity_ah;
        // The drawn fraction is uniform, on a grid of logarithms.
        const double drawn_fraction = std::min(1.0, shown.charge_ah.back() / (capacity_ah - missing_ah));
        const double logarithm = log_likelihood(all, chemistry, capacity_ah, missing_ah, beyond_percent) +
                                 std::log(charts.at(chart).probability * missing.probability * drawn_fraction);
        if (!std::isfinite(logarithm)) return;
        posterior.push_back({capacity_ah, missing_ah, logarithm, missing.is_full, chemistry});
        most = std::max(most, logarithm);
    };
    for (std::size_t chart = 0; chart < charts.size(); ++chart)
        for (const double capacity_ah : capacities(shown, given_ah))
            for (const auto& missing : parts) add(chart, capacity_ah, missing);
    constexpr double negligible = 1e-7;
    double sum = 0.0;
    for (auto& scale : posterior) scale.probability = std::exp(scale.probability - most);
    std::erase_if(posterior, [](const CapacityHypothesis& scale) { return scale.probability < negligible; });
    for (const auto& scale : posterior) sum += scale.probability;
    for (auto& scale : posterior) scale.probability /= sum;
    return posterior;
}

Chemistry most_probable_chemistry(std::span<const CapacityHypothesis> posterior) {
    std::array<double, charts.size()> sums{};
    for (const auto& scale : posterior) sums.at(static_cast<std::size_t>(scale.chemistry)) += scale.probability;
    return static_cast<Chemistry>(std::ranges::max_element(sums) - sums.begin());
}

double capacity_quantile_ah(std::span<const CapacityHypothesis> posterior, double probability) {
    std::vector<std::pair<double, double>> values;
    for (const auto& scale : posterior) values.emplace_back(scale.capacity_ah, scale.probability);
    return weighted_quantile(std::move(values), probability);
}

double estimate_depletion_ah(std::span<const CapacityHypothesis> posterior) {
    const double capacity_ah = capacity_quantile_ah(posterior, 0.5);
    std::vector<std::pair<double, double>> values;
    double sum = 0.0;
    for (const auto& scale : posterior) {
        if (scale.capacity_ah != capacity_ah) continue;
        values.emplace_back(scale.is_full ? 0.0 : scale.missing_ah, scale.probability);
        sum += scale.probability;
    }
    return weighted_quantile(std::move(values), sum / 2.0);
}

Interval depletion_interval_ah(std::span<const CapacityHypothesis> posterior, double offset_ah,
                               double standard_error_ah) {
    constexpr double tolerance_ah = 1e-9;
    const double error_ah = std::max(1e-6, standard_error_ah);
    const auto quantile = [&](double probability, bool full_is_full) {
        const auto below = [&](double missing_ah) {
            double sum = -probability;
            for (const auto& scale : posterior) {
                const double begins_ah = offset_ah + (scale.is_full && full_is_full ? 0.0 : scale.missing_ah);
                sum += 0.5 * scale.probability * std::erfc((begins_ah - missing_ah) / (error_ah * std::numbers::sqrt2));
            }
            return sum;
        };
        double low_ah = -1.0 - std::abs(offset_ah) - 10.0 * error_ah;
        double high_ah = 1.0 + std::abs(offset_ah) + 10.0 * error_ah;
        for (const auto& scale : posterior) high_ah = std::max(high_ah, scale.missing_ah + offset_ah + 10.0 * error_ah);
        std::uintmax_t most_iterations = 100;
        const auto root = boost::math::tools::toms748_solve(
            below, low_ah, high_ah, [](double low, double high) { return high - low < tolerance_ah; }, most_iterations);
        return std::max(0.0, std::midpoint(root.first, root.second));
    };
    constexpr double tail = (1.0 - confidence_level) / 2.0;
    return {quantile(tail, true), quantile(1.0 - tail, false)};
}

}  // namespace flightwatt::battery
