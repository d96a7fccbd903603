#include "live/turn_home.h"

#include "base/units.h"
#include "path/path.h"
#include "path/trajectory.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::live {
namespace {

/// Straight home from a place, level; none where the wind forbids it.
std::optional<battery::ConstantLoad> way_home(const path::PathForecast& path, double on_path_s, double power_factor) {
    const auto& plan = path.plan();
    const auto place = position_at(path.flown(), on_path_s);
    const auto at = local_position_at(plan.path, place);
    const double distance_m = std::hypot(at.east_m, at.north_m);
    const auto& element = plan.path.elements[std::min(place.element, plan.path.elements.size() - 1)];
    const double power_w = mechanical::power_w(plan.power, {.airspeed_m_per_s = element.airspeed_m_per_s});
    if (distance_m < 1.0) return battery::ConstantLoad{power_w * power_factor, 0.0};
    const double course_deg = std::atan2(-at.east_m, -at.north_m) * units::degree_per_rad;
    const auto speed = ground_speed_m_per_s(element.airspeed_m_per_s, course_deg, plan.wind);
    if (!speed) return std::nullopt;
    return battery::ConstantLoad{power_w * power_factor, distance_m / *speed};
}

bool has_failed(const battery::Discharge& end) { return end.ended_at_s() || end.undeliverable; }

bool lands_with_reserve(const ReturnFlightInput& budget, battery::BatteryState state,
                        const std::optional<battery::ConstantLoad>& home) {
    if (!home) return false;
    for (const auto& stretch : {home, budget.landing}) {
        if (!stretch || !(stretch->duration_s > 0.0)) continue;
        const auto end = discharge_constant_load(budget.battery, state, *stretch, budget.limits.cutoff_voltage_v);
        if (has_failed(end)) return false;
        state = end;
    }
    return state.soc_percent >= budget.limits.reserve_soc_percent;
}

double duration_s(const std::vector<battery::ConstantLoad>& stretches) {
    double sum_s = 0.0;
    for (const auto& stretch : stretches) sum_s += stretch.duration_s;
    return sum_s;
}

/// So much more of the stretches ahead; false where the battery fails on it.
bool fly_on(const battery::Battery& battery, const battery::LandingLimits& limits,
            std::vector<battery::ConstantLoad>& ahead, double time_s, battery::BatteryState& state) {
    while (time_s > 0.0 && !ahead.empty()) {
        auto& stretch = ahead.front();
        const double part_s = std::min(time_s, stretch.duration_s);
        if (part_s > 0.0) {
            const auto end =
                discharge_constant_load(battery, state, {stretch.power_w, part_s}, limits.cutoff_voltage_v);
            if (has_failed(end)) return false;
            state = end;
        }
        time_s -= part_s;
        stretch.duration_s -= part_s;
        if (!(stretch.duration_s > 0.0)) ahead.erase(ahead.begin());
    }
    return true;
}

}  // namespace

ReturnDeadline latest_return(const path::PathForecast& path, double on_path_s, const ReturnFlightInput& budget) {
    constexpr double finest_s = 10.0;
    constexpr double max_looks = 40.0;
    const double rest_s = duration_s(budget.cruise_ahead);
    const double step_s = std::max(finest_s, rest_s / max_looks);
    auto ahead = budget.cruise_ahead;
    auto state = budget.now;
    ReturnDeadline turn;
    double in_s = 0.0;
    while (lands_with_reserve(budget, state, way_home(path, on_path_s + in_s, budget.power_factor))) {
        turn.latest_in_s = in_s;
        turn.path_can_be_flown = in_s >= rest_s;
        const double next_s = std::min(step_s, rest_s - in_s);
        if (!(next_s > 0.0) || !fly_on(budget.battery, budget.limits, ahead, next_s, state)) break;
        in_s = rest_s - in_s <= step_s ? rest_s : in_s + next_s;
    }
    return turn;
}

TimeCurve soc_ahead(const PredictionInput& basis, const Prediction& prediction, battery::BatteryState now,
                    double now_s) {
    constexpr double finest_s = 10.0;
    constexpr double max_points = 100.0;
    auto ahead = remaining_power(prediction);
    const double rest_s = duration_s(ahead);
    const double step_s = std::max(finest_s, rest_s / max_points);
    TimeCurve curve{{now_s}, {now.soc_percent}};
    for (double flown_s = 0.0; flown_s < rest_s;) {
        const double part_s = std::min(step_s, rest_s - flown_s);
        if (!fly_on(basis.battery.value(), basis.limits, ahead, part_s, now)) break;
        flown_s += part_s;
        curve.time_s.push_back(now_s + flown_s);
        curve.value.push_back(now.soc_percent);
    }
    return curve;
}

}  // namespace flightwatt::live
