#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace flightwatt::mechanical {
namespace {

constexpr double min_eigenvalue = 1e-8;  // of the columns' products, each of length 1
constexpr double prior_degrees_of_freedom = 3.0;

/// From half a bin, where neighbours are nearly independent, to 45 bins; twice as long at each second step.
std::vector<double> correlations_s(double bin_s) {
    std::vector<double> grid(14);
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = 0.5 * bin_s * std::pow(2.0, 0.5 * static_cast<double>(i));
    return grid;
}

/// From a negligible sd to one as large as the power itself.
std::vector<double> level_sds(std::size_t flights) {
    if (flights < 2) return {0.0};
    std::vector<double> grid(24);
    for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = 0.002 * std::pow(1.32, static_cast<double>(i));
    return grid;
}

/// Of the grid's logarithmic steps.
double log_prior(double level_sd) {
    if (level_sd == 0.0) return 0.0;
    const double ratio = level_sd / level_prior_scale;
    return std::log(level_sd) -
           0.5 * (prior_degrees_of_freedom + 1.0) * std::log1p(ratio * ratio / prior_degrees_of_freedom);
}

std::vector<NormalEquations> select_columns(std::span<const NormalEquations> flights, const std::vector<int>& columns) {
    std::vector<NormalEquations> selected;
    selected.reserve(flights.size());
    for (const auto& flight : flights) selected.push_back(flight.select(columns));
    return selected;
}

/// Residual variance of each flight at its own level; flights of a single bin are absent.
std::vector<double> own_drift_variances_w2(const std::vector<NormalEquations>& flights,
                                           const ColumnVector& coefficients) {
    std::vector<double> variances;
    for (const auto& flight : flights) {
        if (flight.bins < 2) continue;
        const double expected = coefficients.dot(flight.products * coefficients);
        const double level = coefficients.dot(flight.responses) - expected;
        const double square = flight.square_about(coefficients) - level * level / expected;
        variances.push_back(std::max(square, 0.0) / static_cast<double>(flight.bins - 1));
    }
    return variances;
}

bool is_determined(const std::vector<NormalEquations>& flights) {
    ColumnMatrix sum = flights.front().products;
    for (std::size_t i = 1; i < flights.size(); ++i) sum += flights[i].products;
    if (!(sum.diagonal().minCoeff() > 0.0)) return false;
    const ColumnVector root = sum.diagonal().cwiseSqrt().cwiseInverse();
    const ColumnMatrix scaled = root.asDiagonal() * sum * root.asDiagonal();
    const ColumnMatrix least = min_eigenvalue * ColumnMatrix::Identity(sum.rows(), sum.cols());
    return Eigen::LDLT<ColumnMatrix>(scaled - least).isPositive();  // without the eigenvalues, which compile for long
}

/// Normal distribution of the coefficients' errors and, last, the flight's level.
struct ParameterDistribution {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
};

/// Derivatives of the power by the parameters: the terms' values and, last, the power.
Eigen::VectorXd gradient_of(const PhysicalModel& model, const TermValues& values) {
    Eigen::VectorXd gradient(std::ssize(model.terms) + 1);
    gradient << as_columns(values)(columns_of(model.terms)), sum_of_terms_w(model, values);
    return gradient;
}

ParameterDistribution updated_parameters(const PhysicalModel& model, std::span<const FlightBin> flown) {
    const auto count = std::ssize(model.terms);
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(count + 1, count + 1);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j < count; ++j)
            prior(i, j) = model.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    prior(count, count) = std::pow(model.level_sd.value(), 2);
    if (flown.empty() || !(model.drift_sd_w > 0.0)) return {Eigen::VectorXd::Zero(count + 1), prior};
    const auto columns = columns_of(model.terms);
    const auto sums = accumulate_normal_equations(flown, model.correlation_s).select(columns);
    const ColumnVector coefficients = as_columns(model.coefficients)(columns);
    Eigen::MatrixXd of_terms(count, count + 1);  // derivatives of the coefficients by the parameters
    of_terms << Eigen::MatrixXd::Identity(count, count), coefficients;
    const double drift_w2 = model.drift_sd_w * model.drift_sd_w;
    const Eigen::MatrixXd information = of_terms.transpose() * sums.products * of_terms / drift_w2;
    const Eigen::VectorXd score = of_terms.transpose() * (sums.responses - sums.products * coefficients) / drift_w2;
    // (prior^-1 + information)^-1, where the prior may be singular
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(count + 1, count + 1);
    const Eigen::MatrixXd covariance = (identity + prior * information).partialPivLu().solve(prior);
    return {covariance * score, covariance};
}

PosteriorPower posterior_power(const PhysicalModel& model, const ParameterDistribution& parameters,
                               std::span<const FlightBin> flown, double now_s, const MotionAhead& ahead) {
    PosteriorPower power;
    if (ahead.duration_s == 0.0) return power;
    power.model_w = sum_of_terms_w(model, ahead.mean_terms);
    power.level = parameters.mean[parameters.mean.size() - 1];
    auto gradient = gradient_of(model, ahead.mean_terms);
    double mean_w = power.model_w + gradient.dot(parameters.mean);
    double drift_w2 = drift_variance_w2(model, ahead.duration_s);
    if (!flown.empty()) {
        const auto& last = flown.back();
        const double fading = std::exp(-std::max(now_s - last.middle_s(), 0.0) / model.correlation_s) *
                              -std::expm1(-ahead.duration_s / model.correlation_s) * model.correlation_s /
                              ahead.duration_s;
        const double remaining = fading * weight_of_bin(last.duration_s);
        const auto last_gradient = gradient_of(model, last.values);
        mean_w += remaining * (last.power_w - sum_of_terms_w(model, last.values) - last_gradient.dot(parameters.mean));
        gradient -= remaining * last_gradient;
        drift_w2 -= fading * remaining * model.drift_sd_w * model.drift_sd_w;
    }
    power.mean_w = std::max(mean_w, 0.0);
    power.parameter_sd_w = std::sqrt(std::max(gradient.dot(parameters.covariance * gradient), 0.0));
    power.drift_sd_w = std::sqrt(std::max(drift_w2, 0.0));
    return power;
}

}  // namespace

NormalEquations NormalEquations::select(const std::vector<int>& columns) const {
    return {products(columns, columns), responses(columns), square, log_determinant, bins};
}

double NormalEquations::square_about(const ColumnVector& coefficients) const {
    return square + coefficients.dot(products * coefficients - 2.0 * responses);
}

std::vector<int> columns_of(const std::vector<PowerTerm>& terms) {
    std::vector<int> columns;
    columns.reserve(terms.size());
    for (const auto term : terms) columns.push_back(static_cast<int>(term));
    return columns;
}

NormalEquations accumulate_normal_equations(std::span<const FlightBin> bins, double correlation_s) {
    NormalEquations sums;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        ColumnVector column = as_columns(bins[i].values);
        double response = bins[i].power_w;
        if (i > 0 && correlation_s > 0.0) {
            const double correlation = std::exp(-(bins[i].middle_s() - bins[i - 1].middle_s()) / correlation_s);
            const double innovation = 1.0 - correlation * correlation;
            column = (column - correlation * as_columns(bins[i - 1].values)) / std::sqrt(innovation);
            response = (response - correlation * bins[i - 1].power_w) / std::sqrt(innovation);
            sums.log_determinant += std::log(innovation);
        }
        const double weight = std::sqrt(weight_of_bin(bins[i].duration_s));
        column *= weight;
        response *= weight;
        sums.products += column * column.transpose();
        sums.responses += response * column;
        sums.square += response * response;
        ++sums.bins;
    }
    return sums;
}

std::optional<GlsFit> fit_gls(std::span<const NormalEquations> flights, const std::vector<int>& columns,
                              double level_sd) {
    constexpr int rounds = 6;  // the expected power and the drift converge in three
    const auto count = static_cast<Eigen::Index>(columns.size());
    const auto sums = select_columns(flights, columns);
    std::size_t bins = 0;
    for (const auto& flight : flights) bins += flight.bins;
    if (bins <= columns.size() || !is_determined(sums)) return std::nullopt;
    const auto freedom = static_cast<double>(bins - columns.size());
    GlsFit fit;
    ColumnVector expected = ColumnVector::Zero(count);
    for (int round = 0; round < rounds; ++round) {
        const double ratio = round == 0 ? 0.0 : level_sd * level_sd / fit.drift_variance_w2;
        ColumnMatrix normal = ColumnMatrix::Zero(count, count);
        ColumnVector right = ColumnVector::Zero(count);
        double log_determinant = 0.0;
        // The level's part of each flight's covariance is of rank one: Sherman and Morrison.
        std::vector<double> shrink;
        for (const auto& flight : sums) {
            const ColumnVector along = flight.products * expected;
            const double size = expected.dot(along);
            shrink.push_back(ratio / (1.0 + ratio * size));
            normal += flight.products - shrink.back() * along * along.transpose();
            right += flight.responses - shrink.back() * expected.dot(flight.responses) * along;
            log_determinant += flight.log_determinant + std::log1p(ratio * size);
        }
        const Eigen::LDLT<ColumnMatrix> factor(normal);
        if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
        fit.coefficients = factor.solve(right);
        double square = 0.0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const double level = expected.dot(sums[i].responses - sums[i].products * fit.coefficients);
            square += sums[i].square_about(fit.coefficients) - shrink[i] * level * level;
        }
        constexpr double min_w2 = 1e-12;  // bins that a model explains exactly
        fit.drift_variance_w2 = std::max(square / freedom, min_w2);
        fit.log_likelihood =
            -0.5 * (freedom * std::log(fit.drift_variance_w2) + log_determinant + factor.vectorD().array().log().sum());
        expected = fit.coefficients;
        fit.covariance = factor.solve(ColumnMatrix::Identity(count, count)) * fit.drift_variance_w2;
    }
    return fit;
}

ColumnVector mean_coefficients(const PowerPosterior& posterior) {
    ColumnVector mean = ColumnVector::Zero(posterior.fits.front().coefficients.size());
    for (std::size_t i = 0; i < posterior.fits.size(); ++i)
        mean += posterior.weights[i] * posterior.fits[i].coefficients;
    return mean;
}

double usual_bin_s(std::span<const BinnedFlight> flights) {
    constexpr double is_short = 2.0 / 3.0;
    double longest_s = 0.0;
    for (const auto& flight : flights)
        for (const auto& bin : flight.bins) longest_s = std::max(longest_s, bin.duration_s);
    return longest_s < is_short * default_bin_s ? longest_s : default_bin_s;
}

PowerRegression::PowerRegression(std::span<const BinnedFlight> flights)
    : correlations_s_(correlations_s(usual_bin_s(flights))), flights_(flights.size()) {
    for (const double correlation_s : correlations_s_) {
        auto& sums = by_correlation_.emplace_back();
        for (const auto& flight : flights) sums.push_back(accumulate_normal_equations(flight.bins, correlation_s));
    }
}

std::optional<PowerPosterior> PowerRegression::posterior(const std::vector<int>& columns) const {
    PowerPosterior posterior;
    const auto sds = level_sds(flights_);
    for (std::size_t i = 0; i < correlations_s_.size(); ++i) {
        for (const double level_sd : sds) {
            auto fit = fit_gls(by_correlation_[i], columns, level_sd);
            if (!fit) return std::nullopt;
            posterior.nodes.push_back({correlations_s_[i], level_sd});
            posterior.weights.push_back(fit->log_likelihood + log_prior(level_sd));
            posterior.fits.push_back(std::move(*fit));
        }
    }
    const auto max = std::ranges::max_element(posterior.weights);
    posterior.likeliest = static_cast<std::size_t>(max - posterior.weights.begin());
    const double max_logarithm = *max;
    double sum = 0.0;
    for (auto& weight : posterior.weights) sum += weight = std::exp(weight - max_logarithm);
    for (auto& weight : posterior.weights) weight /= sum;
    posterior.drift_variances_w2 =
        own_drift_variances_w2(select_columns(by_correlation_[posterior.likeliest / sds.size()], columns),
                               posterior.fits[posterior.likeliest].coefficients);
    return posterior;
}

std::vector<PosteriorPower> predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown,
                                                    double now_s, std::span<const MotionAhead> ahead) {
    const auto parameters = updated_parameters(model, flown);
    std::vector<PosteriorPower> powers;
    powers.reserve(ahead.size());
    for (const auto& motion : ahead) powers.push_back(posterior_power(model, parameters, flown, now_s, motion));
    return powers;
}

}  // namespace flightwatt::mechanical
