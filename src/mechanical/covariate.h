#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace flightwatt::mechanical {

/// What is known of a flight before its cruise, or early in it (see covariates.h).
enum class Covariate {
    height,
    initial_voltage,
    time_to_cruise,
    wind,
    airspeed,
    ground_speed,
    airspeed_cubed
};

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

}  // namespace flightwatt::mechanical
