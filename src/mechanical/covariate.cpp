#include "mechanical/covariate.h"

#include <string>

#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::array<std::string_view, covariate_count> names{
    "height_m",         "initial_voltage_v",    "time_to_cruise_s",        "wind_m_per_s",
    "airspeed_m_per_s", "ground_speed_m_per_s", "airspeed_cubed_m3_per_s3"};

}  // namespace

std::string_view to_string(Covariate covariate) { return names[static_cast<std::size_t>(covariate)]; }

std::optional<Covariate> covariate_from(std::string_view name) {
    for (const auto covariate : all_covariates) {
        if (to_string(covariate) == name) return covariate;
    }
    return std::nullopt;
}

std::string_view covariate_names() {
    static const auto text = fmt::format("{}", fmt::join(names, ", "));
    return text;
}

}  // namespace flightwatt::mechanical
