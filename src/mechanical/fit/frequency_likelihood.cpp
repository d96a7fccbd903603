#include "mechanical/fit/frequency_likelihood.h"

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/least_squares.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace flightwatt::mechanical {
namespace {

constexpr double min_gap = 0.25;             ///< in median gaps
constexpr double rounding_fraction = 1e-22;  ///< of the values' sum of squares
constexpr double smallest_rounding = 1e-200;

/// The correlation with the sample before.
double decay_of(double gap, double log_autocorrelation) {
    return gap > 0.0 ? std::exp(gap * log_autocorrelation) : 0.0;
}

/// Gram matrix of the rows after R^-1/2, which takes from each sample what the one before told.
Eigen::MatrixXd whitened_gram(const Eigen::MatrixXd& rows, const std::vector<double>& gap, double autocorrelation,
                              double& log_determinant) {
    const Eigen::Index later = rows.rows() - 1;
    const Eigen::ArrayXd decay = (as_vector(gap).tail(later).array() * std::log(autocorrelation)).exp();
    const Eigen::ArrayXd variance = 1.0 - decay.square();
    log_determinant = variance.log().sum();
    const Eigen::VectorXd fresh_part = variance.rsqrt();
    const Eigen::VectorXd told_part = decay * fresh_part.array();
    Eigen::MatrixXd white(rows.rows(), rows.cols());
    white.row(0) = rows.row(0);
    white.bottomRows(later) = fresh_part.asDiagonal() * rows.bottomRows(later);
    white.bottomRows(later) -= told_part.asDiagonal() * rows.topRows(later);
    return white.transpose() * white;
}

/// By so much the logarithm of a likelihood may be behind the best for its frequency to be computed.
constexpr double slack = 15.0;

/// Up to here, two periods, harmonics overlap and Whittle's approximation says little: all frequencies are computed.
constexpr double overlapping_rad = 4.0 * std::numbers::pi;

/// Not more frequencies than this are computed, the most likely ones.
constexpr std::size_t max_frequencies = 300;

/// Variance of noise at an angle per median gap, of all noise 1.
double noise_spectrum(double autocorrelation, double angle_rad) {
    const double r = autocorrelation;
    return (1.0 - r * r) / (1.0 - 2.0 * r * std::cos(angle_rad) + r * r);
}

/// What the screen knows of one flight.
struct ScreenedFlight {
    int order = 0;
    ScanGrid grid;
    double samples = 0.0;
    double step = 0.0;                  ///< median gap
    double square_sum = 0.0;            ///< of the residuals at the frequency found
    std::vector<WhitenedSum> whitened;  ///< of them, one an autocorrelation
    std::vector<double> projected;      ///< least sum of squares at each frequency of the scan
    TrigonometricSums sums;             ///< of the residuals
};

ScreenedFlight screened(const ScaledSamples& samples, int order, const FrequencyRange& range, double found_rad,
                        const std::vector<double>& autocorrelations) {
    ScreenedFlight flight;
    flight.order = order;
    flight.grid = scan_grid(range, order);
    const auto count = 2 * static_cast<std::size_t>(order) * flight.grid.last + 1;
    for (const double sum : scan_flight(samples, order, range).square_sum)
        flight.projected.push_back(std::max(0.0, sum));
    const double total = as_vector(samples.value).squaredNorm();
    auto residuals = samples;
    if (const auto at = project_at_frequency(samples, order, found_rad)) {
        const auto last_column = at->columns.rightCols(1);
        std::copy(last_column.data(), last_column.data() + last_column.size(), residuals.value.begin());
    }
    flight.samples = static_cast<double>(samples.tau.size());
    flight.step = median_gap(samples.tau);
    flight.square_sum = std::max(as_vector(residuals.value).squaredNorm(), 1e-22 * total);
    for (const double r : autocorrelations) {
        flight.whitened.push_back(whitened_sum(residuals.value, normalised_gaps(samples), r));
    }
    flight.sums = sum_by_fft(residuals, flight.grid.step_rad, count);
    return flight;
}

/// Logarithm of the likelihood at frequency i of the grid for the autocorrelation of that place, about.
double screened_log_likelihood(const ScreenedFlight& flight, std::size_t i, std::size_t place, double autocorrelation) {
    double gained = 0.0;           // of the residuals' square sum, by the harmonics here
    double gained_whitened = 0.0;  // of the whitened one
    double log_spectrum = 0.0;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(flight.order); ++k) {
        const double angle = static_cast<double>(k * i) * flight.grid.step_rad * flight.step;
        const double spectrum = noise_spectrum(autocorrelation, angle);
        const double power = 2.0 * std::norm(flight.sums.value[k * i]) / flight.samples;
        gained += power;
        gained_whitened += power / spectrum;
        log_spectrum += std::log(spectrum);
    }
    const auto& whitened = flight.whitened[place];
    const double lost = std::max(0.0, flight.projected[i - flight.grid.first] - flight.square_sum + gained);
    const double least = 1e-3 * whitened.square_sum;
    const double square_sum =
        std::max(least, whitened.square_sum + lost / noise_spectrum(autocorrelation, 0.0) - gained_whitened);
    const double freedom = flight.samples - coefficient_count(flight.order);
    return -0.5 * (whitened.log_determinant + freedom * std::log(std::max(square_sum, 1e-300))) + log_spectrum;
}

/// Least sums of squares of all flights at a frequency.
struct SquareSum {
    double sum = 0.0;
    double product_sum = 0.0;      ///< of neighbouring residuals
    double max_correlation = 0.0;  ///< of them, of the flight that has most
};

/// None where a flight determines no series.
std::optional<SquareSum> square_sum_at(std::span<const ScaledSamples> flights, int order, double theta_rad) {
    SquareSum square;
    for (const auto& samples : flights) {
        const auto at = project_at_frequency(samples, order, theta_rad);
        if (!at) return std::nullopt;
        const Eigen::VectorXd residuals = at->columns.rightCols(1);
        const auto pairs = residuals.size() - 1;
        const double own = residuals.squaredNorm();
        if (!(own > 0.0)) return std::nullopt;
        const double products = residuals.head(pairs).dot(residuals.tail(pairs));
        square.max_correlation = std::max(square.max_correlation, products / own);
        square.product_sum += products;
        square.sum += own;
    }
    return square;
}

/// The correlation of neighbouring residuals that counts: of few flights of many samples the most; of many flights that
/// of all together, with what series of their own take from it. None where neither tells it, or noise lasts.
std::optional<double> correlation_that_counts(std::span<const ScaledSamples> flights, int order,
                                              const SquareSum& square) {
    constexpr std::size_t many_samples = 100;
    constexpr std::size_t many_flights = 30;
    constexpr double most = 0.5;
    constexpr double max_of_many = 0.8;  // what lasts in one flight is not there in the next
    const auto has_fewer = [&](std::size_t least) {
        return std::ranges::any_of(flights, [&](const auto& flight) { return flight.tau.size() < least; });
    };
    if (flights.size() < many_flights) {
        if (has_fewer(many_samples) || square.max_correlation > most) return std::nullopt;
        return square.max_correlation;
    }
    const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
    if (has_fewer(2 * coefficients)) return std::nullopt;
    const auto taken = static_cast<double>(coefficients * flights.size());
    const double pooled = square.product_sum / square.sum + taken / static_cast<double>(sample_count(flights));
    if (pooled > max_of_many) return std::nullopt;
    return std::max(0.0, pooled);
}

}  // namespace

std::vector<double> normalised_gaps(const ScaledSamples& samples) {
    const double step = median_gap(samples.tau);
    std::vector<double> gaps(samples.tau.size(), 0.0);
    for (std::size_t j = 1; j < gaps.size(); ++j) {
        gaps[j] = std::max(min_gap, step > 0.0 ? (samples.tau[j] - samples.tau[j - 1]) / step : 0.0);
    }
    return gaps;
}

std::optional<FrequencyProjection> project_at_frequency(const ScaledSamples& samples, int order, double theta_rad) {
    const auto basis = fourier_basis(samples.tau, order, theta_rad);
    auto fit = solve_least_squares(basis, as_vector(samples.value));
    if (!fit) return std::nullopt;
    FrequencyProjection flight;
    flight.columns.resize(basis.rows(), basis.cols() + 1);
    flight.columns.leftCols(basis.cols()) = basis * fit->from_orthonormal;
    flight.columns.rightCols(1) = as_vector(samples.value) - basis * fit->coefficients;
    flight.from_orthonormal = std::move(fit->from_orthonormal);
    flight.coordinates = std::move(fit->orthonormal);
    flight.gap = normalised_gaps(samples);
    flight.rounding = std::max(rounding_fraction * as_vector(samples.value).squaredNorm(), smallest_rounding);
    return flight;
}

RestrictedLikelihood restricted_likelihood(const FrequencyProjection& flight, double autocorrelation) {
    const Eigen::Index size = flight.columns.cols() - 1;
    double log_determinant = 0.0;
    Eigen::MatrixXd gram;
    if (autocorrelation > 0.0) {
        gram = whitened_gram(flight.columns, flight.gap, autocorrelation, log_determinant);
    } else {
        gram = Eigen::MatrixXd::Identity(size + 1, size + 1);
        gram(size, size) = flight.columns.col(size).squaredNorm();
    }
    RestrictedLikelihood fit;
    fit.cholesky.compute(gram.topLeftCorner(size, size));
    const Eigen::VectorXd shift = fit.cholesky.solve(gram.col(size).head(size));
    fit.coordinates = flight.coordinates + shift;
    fit.square_sum = std::max(gram(size, size) - shift.dot(gram.col(size).head(size)), flight.rounding);
    fit.degrees_of_freedom = static_cast<double>(flight.columns.rows() - size);
    const double log_of_basis = 2.0 * fit.cholesky.matrixLLT().diagonal().array().log().sum();
    fit.log_likelihood = -0.5 * (log_determinant + log_of_basis + fit.degrees_of_freedom * std::log(fit.square_sum));
    return fit;
}

WhitenedSum whitened_sum(std::span<const double> values, const std::vector<double>& gap, double autocorrelation) {
    const double log_r = autocorrelation > 0.0 ? std::log(autocorrelation) : -1e9;
    WhitenedSum sum{values[0] * values[0], 0.0};
    for (std::size_t j = 1; j < values.size(); ++j) {
        const double decay = decay_of(gap[j], log_r);
        const double variance = 1.0 - decay * decay;
        const double fresh = values[j] - decay * values[j - 1];
        sum.square_sum += fresh * fresh / variance;
        sum.log_determinant += std::log(variance);
    }
    return sum;
}

bool is_frequency_determined(std::span<const ScaledSamples> flights, int order, const FrequencyRange& range,
                             double found_rad, const FrequencyScan* known) {
    constexpr double min_log_ratio = 25.0;
    const double beside_rad = 0.5 / order;
    if (found_rad - beside_rad <= range.low_rad || found_rad + beside_rad >= range.high_rad) return false;
    const auto best = square_sum_at(flights, order, found_rad);
    if (!best) return false;
    const auto correlation = correlation_that_counts(flights, order, *best);
    if (!correlation) return false;
    const double freedom =
        static_cast<double>(sample_count(flights)) - static_cast<double>(flights.size()) * coefficient_count(order);
    const double alone = freedom * (1.0 - *correlation) / (1.0 + *correlation);
    const double min_worse = best->sum * std::exp(2.0 * min_log_ratio / alone);
    for (const double theta_rad : {found_rad - beside_rad, found_rad + beside_rad}) {
        const auto beside = square_sum_at(flights, order, theta_rad);
        if (!beside || beside->sum < min_worse) return false;
    }
    const auto scan = known ? *known : scan_frequencies(flights, order, range);
    for (std::size_t i = 0; i < scan.theta_rad.size(); ++i)
        if (std::abs(scan.theta_rad[i] - found_rad) > beside_rad && scan.square_sum[i] < min_worse) return false;
    return true;
}

std::vector<double> coarse_autocorrelations(double highest) {
    constexpr int intervals = 6;
    std::vector<double> values;
    for (int i = 0; i <= intervals; ++i) values.push_back(highest * i / intervals);
    return values;
}

std::vector<double> candidate_frequencies(std::span<const ScaledSamples> flights, int order,
                                          const FrequencyRange& range, double found_rad, double highest) {
    const auto grid = scan_grid(range, order);
    const auto autocorrelations = coarse_autocorrelations(highest);
    std::vector<ScreenedFlight> known;
    for (const auto& samples : flights) known.push_back(screened(samples, order, range, found_rad, autocorrelations));

    std::vector<std::pair<double, double>> found;  // likelihood, frequency
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t place = 0; place < autocorrelations.size(); ++place) {
        double at_found = 0.0;
        for (const auto& flight : known) {
            const double freedom = flight.samples - coefficient_count(order);
            at_found -= 0.5 * (flight.whitened[place].log_determinant +
                               freedom * std::log(std::max(flight.whitened[place].square_sum, 1e-300)));
        }
        best = std::max(best, at_found);
    }
    for (auto i = grid.first; i <= grid.last; ++i) {
        const double theta_rad = static_cast<double>(i) * grid.step_rad;
        double likeliest = -std::numeric_limits<double>::infinity();
        for (std::size_t place = 0; place < autocorrelations.size(); ++place) {
            double sum = -2.0 * std::log(theta_rad / found_rad);
            for (const auto& flight : known) {
                sum += screened_log_likelihood(flight, i, place, autocorrelations[place]);
            }
            likeliest = std::max(likeliest, sum);
        }
        if (theta_rad > overlapping_rad && likeliest < best - slack) continue;
        found.emplace_back(theta_rad > overlapping_rad ? likeliest : std::numeric_limits<double>::infinity(),
                           theta_rad);
    }
    std::ranges::stable_sort(found, std::greater(), &std::pair<double, double>::first);
    if (found.size() > max_frequencies) found.resize(max_frequencies);
    std::vector<double> frequencies;
    frequencies.reserve(found.size());
    for (const auto& [likelihood, theta_rad] : found) frequencies.push_back(theta_rad);
    std::ranges::sort(frequencies);
    return frequencies;
}

}  // namespace flightwatt::mechanical
