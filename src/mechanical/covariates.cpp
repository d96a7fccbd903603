#include "mechanical/covariates.h"

#include "base/statistics.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::array<std::string_view, covariate_count> covariate_texts{
    "height_m",         "initial_voltage_v",    "time_to_cruise_s",        "wind_m_per_s",
    "airspeed_m_per_s", "ground_speed_m_per_s", "airspeed_cubed_m3_per_s3"};

/// The mean of the track's values from `start_s` on, for early_s; std::nullopt without any.
std::optional<double> early_mean(const flight::Track& track, double start_s) {
    std::vector<double> values;
    const auto first = std::ranges::lower_bound(track.time_s, start_s) - track.time_s.begin();
    for (auto i = static_cast<std::size_t>(first); i < track.time_s.size(); ++i) {
        if (track.time_s[i] > start_s + early_s) break;
        values.push_back(track.value[i]);
    }
    if (values.empty()) return std::nullopt;
    return mean(values);
}

std::optional<double> resting_voltage_v(const flight::SelectedTracks& tracks, double lift_off_s) {
    constexpr double watched_s = 120.0;
    const auto& time_s = tracks["power_w"].time_s;
    const auto& voltage = tracks["voltage_v"];
    const auto& throttle = tracks["throttle_percent"];
    if (voltage.empty() || throttle.empty()) return std::nullopt;
    const double idle_percent = flight::SegmentationOptions{}.idle_throttle_percent;
    std::vector<double> voltages;
    const auto first = std::ranges::lower_bound(time_s, lift_off_s - watched_s) - time_s.begin();
    for (auto i = static_cast<std::size_t>(first); i < time_s.size() && time_s[i] < lift_off_s; ++i) {
        if (value_at(throttle, time_s[i]) <= idle_percent) voltages.push_back(value_at(voltage, time_s[i]));
    }
    if (voltages.empty()) return std::nullopt;
    return median_high(std::move(voltages));  // of an even number: one that was measured
}

}  // namespace

std::string_view to_string(Covariate covariate) { return covariate_texts[static_cast<std::size_t>(covariate)]; }

std::optional<Covariate> covariate_from(std::string_view name) {
    for (const auto covariate : all_covariates)
        if (to_string(covariate) == name) return covariate;
    return std::nullopt;
}

std::string_view covariate_names() {
    static const auto text = fmt::format("{}", fmt::join(covariate_texts, ", "));
    return text;
}

Covariates covariates_of(const flight::SelectedTracks& tracks, const flight::Sortie& sortie) {
    Covariates found;
    const auto& airspeed = tracks["airspeed_m_per_s"];
    found[Covariate::height] = sortie.height_m;
    for (const auto& span : sortie.phases) {
        if (span.phase == flight::Phase::takeoff && span.complete) {
            found[Covariate::initial_voltage] = resting_voltage_v(tracks, span.start.time_s);
        }
        if (span.phase != flight::Phase::cruise) continue;
        const double start_s = span.start.time_s;
        if (const auto& first = sortie.phases.front(); first.phase == flight::Phase::takeoff && first.complete) {
            found[Covariate::time_to_cruise] = start_s - first.start.time_s;
        }
        found[Covariate::wind] = early_mean(tracks["wind_speed_m_per_s"], start_s);
        found[Covariate::airspeed] = early_mean(airspeed, start_s);
        found[Covariate::ground_speed] = early_mean(tracks["ground_speed_m_per_s"], start_s);
        found[Covariate::airspeed_cubed] = mean_cubed_airspeed_m3_per_s3(airspeed, start_s, start_s + early_s);
    }
    return found;
}

RegressionPrediction predict_mean_power(const CovariateRegression& law, double value) {
    const auto flights = static_cast<double>(law.flights);
    RegressionPrediction level;
    level.within_flights = value >= law.least && value <= law.most;
    level.sd_w = law.residual_sd_w;
    if (is_through_origin(law.covariate)) {
        const double ratio = value / law.mean;
        level.power_w = std::max(0.0, law.mean_power_w * ratio);
        level.law_variance = 1.0 / flights;
        level.degrees_of_freedom = flights - 1.0;
        if (level.sd_w) *level.sd_w *= ratio;
        return level;
    }
    const double z = (std::clamp(value, law.least, law.most) - law.mean) / law.sd;
    level.power_w = std::max(0.0, law.mean_power_w + law.slope_w * z);
    // The ridge adds a flight one standard deviation off, so the squares of the standardised values sum to n.
    level.law_variance = (1.0 + z * z) / flights;
    level.degrees_of_freedom = flights - 2.0;
    return level;
}

ConstantPower constant_power(const RegressionPrediction& level) {
    ConstantPower power{level.power_w, std::nullopt, 0.0};
    if (!level.sd_w) return power;
    power.sd_w = *level.sd_w * std::sqrt(1.0 + level.law_variance);
    power.degrees_of_freedom = level.degrees_of_freedom;
    return power;
}

}  // namespace flightwatt::mechanical
