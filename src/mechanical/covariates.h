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

}  // namespace flightwatt::mechanical
