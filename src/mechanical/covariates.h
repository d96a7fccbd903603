#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace flightwatt::flight {
class SelectedTracks;
struct Sortie;
}  // namespace flightwatt::flight

namespace flightwatt::mechanical {

/// What is known of a flight before its cruise, or early in it (see covariates_of).
enum class Covariate { height, initial_voltage, time_to_cruise, wind, airspeed, ground_speed, airspeed_cubed };

inline constexpr std::size_t covariate_count = 7;
inline constexpr std::array<Covariate, covariate_count> all_covariates{
    Covariate::height,   Covariate::initial_voltage, Covariate::time_to_cruise, Covariate::wind,
    Covariate::airspeed, Covariate::ground_speed,    Covariate::airspeed_cubed};

struct Covariates {
    std::array<std::optional<double>, covariate_count> values{};
    std::optional<double>& operator[](Covariate c) { return values[static_cast<std::size_t>(c)]; }
    const std::optional<double>& operator[](Covariate c) const { return values[static_cast<std::size_t>(c)]; }
};

/// "height_m" and so on, as options, model files, missions and the models of a validation call them.
std::string_view to_string(Covariate covariate);
std::optional<Covariate> covariate_from(std::string_view name);

/// All names, for messages: "height_m, initial_voltage_v, ...".
std::string_view covariate_names();

/// How long the cruise is watched for what is known early.
inline constexpr double early_s = 60.0;

/// What a log tells of a sortie before its cruise and early in it; absent where it was not measured.
///   height_m                   the height held above the ground, as it would have been planned
///   initial_voltage_v          median voltage with an idle motor, up to 120 s before lift-off
///   time_to_cruise_s           from lift-off to the cruise
///   wind_m_per_s, airspeed_m_per_s, ground_speed_m_per_s   means over the first early_s of the cruise
///   airspeed_cubed_m3_per_s3   mean cube of the airspeed over that time
Covariates covariates_of(const flight::SelectedTracks& tracks, const flight::Sortie& sortie);

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
