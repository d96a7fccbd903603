#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace flightwatt::mechanical {
namespace {

constexpr double min_condition = 1e-8;  // of the columns' products, each of length 1
constexpr double prior_degrees_of_freedom = 3.0;

/// From half a bin, where neighbours are nearly independent, to 20 minutes; twice as long at each second step.
std::vector<double> correlations_s() {
    std::vector<double> grid(14);
    for (std::size_t i = 0; i < grid.size(); ++i)
        grid[i] = 0.5 * default_bin_s * std::pow(2.0, 0.5 * static_cast<double>(i));
    return grid;
}

/// From far below what a prediction would feel to as much as the power itself.
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

/// Sums of the chosen columns alone.
struct ChosenSums {
    ColumnMatrix products;
    ColumnVector responses;
    double square = 0.0;
    double log_determinant = 0.0;
};

std::vector<ChosenSums> chosen_sums(std::span<const NormalEquations> flights, const std::vector<int>& columns) {
    std::vector<ChosenSums> chosen;
    chosen.reserve(flights.size());
    for (const auto& of : flights)
        chosen.push_back({of.products(columns, columns), of.responses(columns), of.square, of.log_determinant});
    return chosen;
}

/// What each flight's power leaves, its own level taken out; flights of a single bin are absent.
std::vector<double> own_drift_variances_w2(std::span<const NormalEquations> flights, const std::vector<int>& columns,
                                           const ColumnVector& coefficients) {
    std::vector<double> variances;
    for (const auto& of : flights) {
        if (of.bins < 2) continue;
        const ColumnMatrix products = of.products(columns, columns);
        const ColumnVector responses = of.responses(columns);
        const ColumnVector fitted = products * coefficients;
        const double expected = coefficients.dot(fitted);
        const double level = coefficients.dot(responses) - expected;
        const double square = of.square - 2.0 * coefficients.dot(responses) + expected - level * level / expected;
        variances.push_back(std::max(square, 0.0) / static_cast<double>(of.bins - 1));
    }
    return variances;
}

bool is_determined(const std::vector<ChosenSums>& flights) {
    ColumnMatrix sum = flights.front().products;
    for (std::size_t i = 1; i < flights.size(); ++i) sum += flights[i].products;
    if (!(sum.diagonal().minCoeff() > 0.0)) return false;
    const ColumnVector root = sum.diagonal().cwiseSqrt().cwiseInverse();
    const ColumnMatrix scaled = root.asDiagonal() * sum * root.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<ColumnMatrix> solver(scaled, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().minCoeff() > min_condition;
}

/// Coefficients (over column_scale) and, last, the level: what a flight teaches.
struct Learned {
    ColumnVector mean;  ///< less what the model says
    ColumnMatrix covariance;
};

ColumnVector coefficients_of(const PhysicalModel& model) {
    const auto scale = column_scale();
    ColumnVector coefficients(static_cast<Eigen::Index>(model.terms.size()));
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        coefficients[static_cast<Eigen::Index>(i)] =
            model.coefficients[model.terms[i]] * scale[static_cast<int>(model.terms[i])];
    return coefficients;
}

/// The terms' values and, last, the power of them: what multiplies what is learned.
ColumnVector row_of(const PhysicalModel& model, const TermValues& values) {
    const auto scale = column_scale();
    const auto count = static_cast<Eigen::Index>(model.terms.size());
    ColumnVector row(count + 1);
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        row[static_cast<Eigen::Index>(i)] = values[model.terms[i]] / scale[static_cast<int>(model.terms[i])];
    row[count] = sum_of_terms_w(model, values);
    return row;
}

ColumnMatrix prior_covariance(const PhysicalModel& model) {
    const auto scale = column_scale();
    const auto count = static_cast<Eigen::Index>(model.terms.size());
    ColumnMatrix prior = ColumnMatrix::Zero(count + 1, count + 1);
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        for (std::size_t j = 0; j < model.terms.size(); ++j)
            prior(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                model.covariance[i][j] * scale[static_cast<int>(model.terms[i])] *
                scale[static_cast<int>(model.terms[j])];
    prior(count, count) = std::pow(model.level_sd.value(), 2);
    return prior;
}

Learned learned_from(const PhysicalModel& model, std::span<const FlightBin> flown) {
    const auto prior = prior_covariance(model);
    const auto count = prior.rows() - 1;
    if (flown.empty() || !(model.drift_sd_w > 0.0)) return {ColumnVector::Zero(count + 1), prior};
    const auto sums = accumulate_normal_equations(flown, model.correlation_s);
    const auto columns = columns_of(model.terms);
    const ColumnVector coefficients = coefficients_of(model);
    const ColumnMatrix products = sums.products(columns, columns);
    const ColumnVector along = products * coefficients;
    const ColumnVector responses = sums.responses(columns);
    ColumnMatrix information(count + 1, count + 1);
    information << products, along, along.transpose(), coefficients.dot(along);
    ColumnVector residual(count + 1);
    residual << responses - along, coefficients.dot(responses) - coefficients.dot(along);
    information /= model.drift_sd_w * model.drift_sd_w;
    residual /= model.drift_sd_w * model.drift_sd_w;
    // (prior^-1 + information)^-1, where the prior may be singular
    const ColumnMatrix unit = ColumnMatrix::Identity(count + 1, count + 1);
    const ColumnMatrix covariance = (unit + prior * information).partialPivLu().solve(prior);
    return {covariance * residual, covariance};
}

PosteriorPower posterior_power(const PhysicalModel& model, const Learned& learned, std::span<const FlightBin> flown,
                               double now_s, const MotionAhead& ahead) {
    PosteriorPower power;
    if (ahead.duration_s == 0.0) return power;
    power.model_w = sum_of_terms_w(model, ahead.mean_terms);
    power.level = learned.mean[learned.mean.size() - 1];
    ColumnVector row = row_of(model, ahead.mean_terms);
    double mean_w = power.model_w + row.dot(learned.mean);
    double drift_w2 = variance_of_mean_w2({model.drift_sd_w, model.correlation_s}, ahead.duration_s);
    if (!flown.empty()) {
        const auto& last = flown.back();
        const double kept = std::exp(-std::max(now_s - last.middle_s(), 0.0) / model.correlation_s) *
                            -std::expm1(-ahead.duration_s / model.correlation_s) * model.correlation_s /
                            ahead.duration_s;
        const ColumnVector last_row = row_of(model, last.values);
        mean_w += kept * (last.power_w - sum_of_terms_w(model, last.values) - last_row.dot(learned.mean));
        row -= kept * last_row;
        drift_w2 -= kept * kept * model.drift_sd_w * model.drift_sd_w;
    }
    power.mean_w = std::max(mean_w, 0.0);
    power.parameter_sd_w = std::sqrt(std::max(row.dot(learned.covariance * row), 0.0));
    power.parameter_degrees_of_freedom = model.degrees_of_freedom;
    power.drift_sd_w = std::sqrt(std::max(drift_w2, 0.0));
    power.drift_degrees_of_freedom = model.drift_degrees_of_freedom;
    return power;
}

}  // namespace

ColumnVector column_scale() {
    ColumnVector scale(column_count);
    scale << 1000.0, 0.1, 0.1, 1.0, 1.0, 1.0;
    return scale;
}

ColumnVector column_values(const FlightBin& bin, const ColumnVector& scale) {
    ColumnVector values(column_count);
    for (const auto term : all_power_terms) values[static_cast<int>(term)] = bin.values[term];
    return values.cwiseQuotient(scale);
}

std::vector<int> columns_of(const std::vector<PowerTerm>& terms) {
    std::vector<int> columns;
    columns.reserve(terms.size());
    for (const auto term : terms) columns.push_back(static_cast<int>(term));
    return columns;
}

NormalEquations accumulate_normal_equations(std::span<const FlightBin> bins, double correlation_s) {
    const auto scale = column_scale();
    NormalEquations sums;
    ColumnVector last;
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const ColumnVector now = column_values(bins[i], scale);
        ColumnVector column = now;
        double response = bins[i].power_w;
        if (i > 0 && correlation_s > 0.0) {
            const double kept = std::exp(-(bins[i].middle_s() - bins[i - 1].middle_s()) / correlation_s);
            const double innovation = 1.0 - kept * kept;
            column = (now - kept * last) / std::sqrt(innovation);
            response = (response - kept * bins[i - 1].power_w) / std::sqrt(innovation);
            sums.log_determinant += std::log(innovation);
        }
        sums.products += column * column.transpose();
        sums.responses += response * column;
        sums.square += response * response;
        ++sums.bins;
        last = now;
    }
    return sums;
}

std::optional<GlsFit> fit_gls(std::span<const NormalEquations> flights, const std::vector<int>& columns,
                              double level_sd) {
    constexpr int rounds = 6;  // the expected power and the drift settle in three
    const auto count = static_cast<Eigen::Index>(columns.size());
    const auto sums = chosen_sums(flights, columns);
    std::size_t bins = 0;
    for (const auto& of : flights) bins += of.bins;
    if (bins <= columns.size() || !is_determined(sums)) return std::nullopt;
    GlsFit fit;
    ColumnVector expected = ColumnVector::Zero(count);
    ColumnMatrix normal;
    for (int round = 0; round < rounds; ++round) {
        const double ratio = round == 0 ? 0.0 : level_sd * level_sd / fit.drift_variance_w2;
        normal = ColumnMatrix::Zero(count, count);
        ColumnVector right = ColumnVector::Zero(count);
        double log_determinant = 0.0;
        // The level's part of each flight's covariance is of rank one: Sherman and Morrison.
        std::vector<double> shrink;
        for (const auto& of : sums) {
            const ColumnVector along = of.products * expected;
            const double size = expected.dot(along);
            shrink.push_back(ratio / (1.0 + ratio * size));
            normal += of.products - shrink.back() * along * along.transpose();
            right += of.responses - shrink.back() * expected.dot(of.responses) * along;
            log_determinant += of.log_determinant + std::log1p(ratio * size);
        }
        const Eigen::LDLT<ColumnMatrix> factor(normal);
        if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
        fit.coefficients = factor.solve(right);
        double square = 0.0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const ColumnVector fitted = sums[i].products * fit.coefficients;
            const double level = expected.dot(sums[i].responses) - expected.dot(fitted);
            square += sums[i].square - 2.0 * fit.coefficients.dot(sums[i].responses) + fit.coefficients.dot(fitted) -
                      shrink[i] * level * level;
        }
        const auto freedom = static_cast<double>(bins - columns.size());
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

PowerRegression::PowerRegression(std::span<const BinnedFlight> flights) : flights_(flights.size()) {
    for (const double correlation_s : correlations_s()) {
        auto& sums = by_correlation_.emplace_back();
        for (const auto& flight : flights) sums.push_back(accumulate_normal_equations(flight.bins, correlation_s));
    }
}

std::optional<PowerPosterior> PowerRegression::posterior(const std::vector<int>& columns) const {
    PowerPosterior posterior;
    const auto correlations = correlations_s();
    for (std::size_t i = 0; i < correlations.size(); ++i) {
        for (const double level_sd : level_sds(flights_)) {
            auto fit = fit_gls(by_correlation_[i], columns, level_sd);
            if (!fit) return std::nullopt;
            posterior.nodes.push_back({correlations[i], level_sd});
            posterior.weights.push_back(fit->log_likelihood + log_prior(level_sd));
            posterior.fits.push_back(std::move(*fit));
        }
    }
    const auto most = std::ranges::max_element(posterior.weights);
    posterior.likeliest = static_cast<std::size_t>(most - posterior.weights.begin());
    const double highest = *most;
    double sum = 0.0;
    for (auto& weight : posterior.weights) sum += weight = std::exp(weight - highest);
    for (auto& weight : posterior.weights) weight /= sum;
    const auto correlation = posterior.likeliest / level_sds(flights_).size();
    posterior.drift_variances_w2 =
        own_drift_variances_w2(by_correlation_[correlation], columns, posterior.fits[posterior.likeliest].coefficients);
    return posterior;
}

std::vector<PosteriorPower> predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown,
                                                    double now_s, std::span<const MotionAhead> ahead) {
    const auto learned = learned_from(model, flown);
    std::vector<PosteriorPower> powers;
    powers.reserve(ahead.size());
    for (const auto& motion : ahead) powers.push_back(posterior_power(model, learned, flown, now_s, motion));
    return powers;
}

}  // namespace flightwatt::mechanical
