#include "path/remaining_path.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flightwatt::path {

namespace {

constexpr std::size_t winds_each = 7;

/// A value that is spread normally, as equally likely ones.
std::vector<double> spread_values(double mean, double sd) {
    if (!(sd > 0.0)) return {mean};
    std::vector<double> values(winds_each);
    double square = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = normal_quantile((static_cast<double>(i) + 0.5) / winds_each);
        square += values[i] * values[i] / winds_each;
    }
    for (auto& value : values) value = mean + sd * value / std::sqrt(square);  // so that their sd is sd
    return values;
}

std::vector<Wind> likely_winds(const Wind& wind) {
    std::vector<Wind> winds;
    for (const double speed_m_per_s : spread_values(wind.speed_m_per_s, wind.speed_sd_m_per_s)) {
        for (const double from_deg : spread_values(wind.from_deg, wind.direction_sd_deg))
            winds.push_back({std::max(speed_m_per_s, 0.0), from_deg});
    }
    return winds;
}

}  // namespace

PathForecast::PathForecast(PlannedPath plan) : plan_(std::move(plan)) {
    for (const auto& wind : likely_winds(plan_.wind))
        in_likely_winds_.push_back(compute_trajectory(plan_.path, wind, InfeasibleLegPolicy::crawl));
    flown_ = compute_trajectory(plan_.path, plan_.wind, InfeasibleLegPolicy::crawl);
}

const PathTrajectory& PathForecast::flown() const {
    if (!flown_.infeasible_elements.empty()) compute_trajectory(plan_.path, plan_.wind);  // throws
    return flown_;
}

RemainingPath PathForecast::predict(const mechanical::FlightProgress& flown, const PathPosition& place) const {
    RemainingPath rest;
    std::vector<mechanical::MotionAhead> in_winds;
    for (const auto& in_wind : in_likely_winds_) {
        const auto ahead = remaining_trajectory(in_wind, place);
        if (!ahead.infeasible_elements.empty()) continue;
        in_winds.push_back({mean_terms(plan_.power, ahead), ahead.duration_s});
        rest.duration_s += ahead.duration_s;
    }
    std::vector<double> energies_wh;
    for (const auto& cruise : predict_remaining_physical(plan_.power, flown, in_winds))
        energies_wh.push_back(cruise.energy.energy_wh);
    const auto count = static_cast<double>(energies_wh.size());
    rest.infeasible_fraction = 1.0 - count / static_cast<double>(in_likely_winds_.size());
    if (rest.infeasible_fraction > 0.5)
        throw NoResultError("the rest of the path is infeasible in most of the winds by [wind]");
    rest.duration_s /= count;
    rest.trajectory = remaining_trajectory(flown_, place);
    const auto& ahead = rest.trajectory;
    rest.cruise = predict_remaining_physical(plan_.power, flown, {mean_terms(plan_.power, ahead), ahead.duration_s});
    rest.cruise.energy.energy_wh = mean(energies_wh);
    if (rest.duration_s > 0.0)
        rest.cruise.remaining_mean_w = units::joule_from_wh(rest.cruise.energy.energy_wh) / rest.duration_s;
    if (energies_wh.size() > 1)
        add_variance(rest.cruise.energy, sample_variance(energies_wh) * (count - 1.0) / count,
                     std::numeric_limits<double>::infinity());
    return rest;
}

}  // namespace flightwatt::path
