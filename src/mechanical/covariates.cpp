#include "mechanical/covariates.h"

#include "flight/airspeed.h"
#include "mechanical/level_spread.h"
#include "mechanical/moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace flightwatt {
namespace {

constexpr std::array<std::string_view, covariate_count> names{
    "height_m",         "initial_voltage_v",    "wind_m_per_s",
    "airspeed_m_per_s", "ground_speed_m_per_s", "airspeed_cubed_m3_per_s3"};

/// The mean of the track's values from `start_s` on, for early_s; std::nullopt without any.
std::optional<double> early_mean(const Track& track, double start_s) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < track.time_s.size(); ++i) {
        if (track.time_s[i] < start_s || track.time_s[i] > start_s + early_s) continue;
        sum += track.value[i];
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

std::optional<double> resting_voltage_v(const FlightSeries& series, double lift_off_s) {
    constexpr double watched_s = 120.0;
    if (series.voltage_v.empty() || series.throttle_percent.empty()) return std::nullopt;
    const double idle_percent = SegmentationOptions{}.idle_throttle_percent;
    std::vector<double> voltages;
    for (std::size_t i = 0; i < series.time_s.size() && series.time_s[i] < lift_off_s; ++i) {
        if (series.time_s[i] < lift_off_s - watched_s || series.throttle_percent[i] > idle_percent) continue;
        voltages.push_back(series.voltage_v[i]);
    }
    if (voltages.empty()) return std::nullopt;
    const auto middle = voltages.begin() + static_cast<std::ptrdiff_t>(voltages.size() / 2);
    std::nth_element(voltages.begin(), middle, voltages.end());
    return *middle;
}

/// The flights' values of a covariate and their mean powers.
struct Points {
    std::vector<double> covariate;
    std::vector<double> power_w;
};

Points points_of(std::span<const PhaseSamples> flights, Covariate covariate) {
    Points points;
    for (const auto& flight : flights) {
        if (!flight.covariates[covariate]) continue;
        points.covariate.push_back(*flight.covariates[covariate]);
        points.power_w.push_back(mean_power_w(flight));
    }
    return points;
}

ConstantPower power_on_line(const Points& points, double value) {
    const auto count = static_cast<double>(points.covariate.size());
    const double centre = mean_of(points.covariate);
    const double scale = sample_sd(points.covariate);
    const double mean_w = mean_of(points.power_w);
    double square_sum = 1.0;  // the ridge: one more flight
    double product_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        const double z = (points.covariate[i] - centre) / scale;
        square_sum += z * z;
        product_sum += z * (points.power_w[i] - mean_w);
    }
    const double slope_w = product_sum / square_sum;
    const auto [least, most] = std::minmax_element(points.covariate.begin(), points.covariate.end());
    const double z = (std::clamp(value, *least, *most) - centre) / scale;
    ConstantPower power{std::max(0.0, mean_w + slope_w * z), std::nullopt, 0.0};
    if (points.covariate.size() < 3) return power;
    double residual_square_sum = 0.0;
    for (std::size_t i = 0; i < points.covariate.size(); ++i) {
        const double fitted_w = mean_w + slope_w * (points.covariate[i] - centre) / scale;
        residual_square_sum += std::pow(points.power_w[i] - fitted_w, 2);
    }
    power.freedom = count - 2.0;
    power.sd_w = std::sqrt(residual_square_sum / power.freedom * (1.0 + 1.0 / count + z * z / square_sum));
    return power;
}

}  // namespace

std::string_view to_string(Covariate covariate) { return names[static_cast<std::size_t>(covariate)]; }

std::optional<Covariate> covariate_from(std::string_view name) {
    for (const auto covariate : all_covariates) {
        if (to_string(covariate) == name) return covariate;
    }
    return std::nullopt;
}

Covariates covariates_of(const FlightSeries& series, const Sortie& sortie) {
    Covariates found;
    found[Covariate::height] = sortie.height_m;
    for (const auto& span : sortie.phases) {
        if (span.phase == Phase::takeoff && span.complete) {
            found[Covariate::initial_voltage] = resting_voltage_v(series, span.start.time_s);
        }
        if (span.phase != Phase::cruise) continue;
        const double start_s = span.start.time_s;
        found[Covariate::wind] = early_mean(series.wind_speed_track, start_s);
        found[Covariate::airspeed] = early_mean(series.airspeed_track, start_s);
        found[Covariate::ground_speed] = early_mean(series.ground_speed_track, start_s);
        found[Covariate::airspeed_cubed] =
            mean_cubed_airspeed_m3_per_s3(series.airspeed_track, start_s, start_s + early_s);
    }
    return found;
}

std::optional<ConstantPower> power_by_covariate(std::span<const PhaseSamples> others,
                                                const PhaseSamples& flight, Covariate covariate) {
    const auto& value = flight.covariates[covariate];
    if (!value) return std::nullopt;
    if (covariate == Covariate::airspeed_cubed) return power_at_airspeed(others, value);
    const auto points = points_of(others, covariate);
    if (points.covariate.size() < 2 || !(sample_sd(points.covariate) > 0.0)) return std::nullopt;
    return power_on_line(points, *value);
}

}  // namespace flightwatt
