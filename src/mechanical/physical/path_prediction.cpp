#include "mechanical/physical/path_prediction.h"

#include "mechanical/physical/power_regression.h"
#include "mechanical/physical/term_choice.h"
#include "mechanical/prediction/variance_components.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace flightwatt::mechanical {
namespace {

/// Coefficients (over column_scale) and, last, the level: what a flight teaches.
struct Learned {
    Eigen::VectorXd mean;  ///< less what the model says
    Eigen::MatrixXd covariance;
};

Eigen::VectorXd coefficients_of(const PhysicalModel& model) {
    const auto scale = column_scale();
    Eigen::VectorXd coefficients(static_cast<Eigen::Index>(model.terms.size()));
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        coefficients[static_cast<Eigen::Index>(i)] =
            model.coefficients[model.terms[i]] * scale[static_cast<int>(model.terms[i])];
    return coefficients;
}

/// The terms' values and, last, the power of them: what multiplies what is learned.
Eigen::VectorXd row_of(const PhysicalModel& model, const TermValues& values) {
    const auto scale = column_scale();
    const auto count = static_cast<Eigen::Index>(model.terms.size());
    Eigen::VectorXd row(count + 1);
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        row[static_cast<Eigen::Index>(i)] = values[model.terms[i]] / scale[static_cast<int>(model.terms[i])];
    row[count] = sum_of_terms_w(model, values);
    return row;
}

Eigen::MatrixXd prior_covariance(const PhysicalModel& model) {
    const auto scale = column_scale();
    const auto count = static_cast<Eigen::Index>(model.terms.size());
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(count + 1, count + 1);
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
    if (flown.empty() || !(model.drift_sd_w > 0.0)) return {Eigen::VectorXd::Zero(count + 1), prior};
    const auto sums = accumulate_normal_equations(flown, model.correlation_s);
    const auto columns = columns_of(model.terms);
    const Eigen::VectorXd coefficients = coefficients_of(model);
    const Eigen::MatrixXd products = sums.products(columns, columns);
    const Eigen::VectorXd along = products * coefficients;
    const Eigen::VectorXd responses = sums.responses(columns);
    Eigen::MatrixXd information(count + 1, count + 1);
    information << products, along, along.transpose(), coefficients.dot(along);
    Eigen::VectorXd residual(count + 1);
    residual << responses - along, coefficients.dot(responses) - coefficients.dot(along);
    information /= model.drift_sd_w * model.drift_sd_w;
    residual /= model.drift_sd_w * model.drift_sd_w;
    // (prior^-1 + information)^-1, where the prior may be singular
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(count + 1, count + 1);
    const Eigen::MatrixXd covariance = (unit + prior * information).partialPivLu().solve(prior);
    return {covariance * residual, covariance};
}

}  // namespace

PosteriorPower predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown, double now_s,
                                       const TermValues& ahead, double remaining_s) {
    const auto learned = learned_from(model, flown);
    const DriftProcess drift{model.drift_sd_w, model.correlation_s};
    PosteriorPower power;
    power.model_w = sum_of_terms_w(model, ahead);
    power.level = learned.mean[learned.mean.size() - 1];
    Eigen::VectorXd row = row_of(model, ahead);
    double mean_w = power.model_w + row.dot(learned.mean);
    double drift_w2 = variance_of_mean_w2(drift, remaining_s);
    if (!flown.empty()) {
        const auto& last = flown.back();
        const double kept = std::exp(-std::max(now_s - last.middle_s(), 0.0) / model.correlation_s) *
                            -std::expm1(-remaining_s / model.correlation_s) * model.correlation_s / remaining_s;
        const Eigen::VectorXd last_row = row_of(model, last.values);
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

}  // namespace flightwatt::mechanical
