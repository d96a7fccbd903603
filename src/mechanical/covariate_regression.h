#pragma once

#include "mechanical/covariates.h"

#include <optional>
#include <span>

namespace flightwatt::mechanical {

struct PhaseSamples;

/// How a phase's level, which is its mean power, follows one covariate v, from several flights:
///     level = mean_power_w + slope_w (v - mean) / sd
/// For airspeed_cubed the line goes through the origin (drag's power in level flight at constant propulsive
/// efficiency) and the spread is a part of the power; for the others the line is least squares with a ridge
/// that weighs as one more flight.
struct CovariateRegression {
    Covariate covariate = Covariate::height;
    std::size_t flights = 0;
    double mean = 0.0;  ///< of the flights' covariates, in the covariate's unit; so are sd, least and most
    double sd = 0.0;
    double least = 0.0;
    double most = 0.0;
    double mean_power_w = 0.0;
    double slope_w = 0.0;                 ///< per standard deviation of the covariate
    std::optional<double> residual_sd_w;  ///< of a flight about the line, at the mean; absent if too few
};

constexpr bool is_through_origin(Covariate covariate) { return covariate == Covariate::airspeed_cubed; }

/// How many flights a law and its spread need: one more than the line has parameters.
constexpr std::size_t min_regression_flights(Covariate covariate) { return is_through_origin(covariate) ? 2 : 3; }

/// The law of `flights` (those that have the covariate), each counting the same; std::nullopt if fewer than 2
/// have it, it is the same in all of them, or, for airspeed_cubed, their power is 0 on average. For
/// airspeed_cubed the flights' values are means over the whole phase, not over its beginning.
std::optional<CovariateRegression> fit_covariate_regression(std::span<const PhaseSamples> flights, Covariate covariate);

/// The level that a law lets expect at one value.
struct RegressionPrediction {
    double power_w = 0.0;
    std::optional<double> sd_w;       ///< of a flight about it, without the law's own error
    double law_variance = 0.0;        ///< of the law's own error, in sd_w^2
    double degrees_of_freedom = 0.0;  ///< of sd_w
    bool within_flights = true;       ///< the value is one that the flights showed
};

/// Beyond what the flights showed a line counts as at their nearest, for a line through so few flights does
/// not reach further; a law through the origin does.
RegressionPrediction predict_mean_power(const CovariateRegression& law, double value);

/// A phase's power as one constant.
struct ConstantPower {
    double mean_w = 0.0;
    std::optional<double> sd_w;  ///< of a flight's mean power about it, its own error included
    double degrees_of_freedom = 0.0;
};

/// The level as a constant power, the law's own error in its spread.
ConstantPower constant_power(const RegressionPrediction& level);

}  // namespace flightwatt::mechanical
