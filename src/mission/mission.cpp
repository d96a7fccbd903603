#include "mission/mission.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace flightwatt::mission {

const MissionSetup& setup_of(const MissionVariant& mission) {
    return std::visit([](const auto& either) -> const MissionSetup& { return either.setup; }, mission);
}

std::optional<Interval> capacity_interval_ah(const MissionSetup& mission) {
    const auto percent = mission.uncertainty.capacity_sd_percent;
    if (!percent) return mission.capacity_is_stated ? std::nullopt : mission.battery.intervals.capacity_ah;
    if (!(*percent > 0.0)) return std::nullopt;
    const double capacity_ah = mission.battery.capacity_ah;
    const double reach_ah = sd_per_half_95 * units::amount_from_percent(capacity_ah, *percent);
    return Interval{capacity_ah - reach_ah, capacity_ah + reach_ah};
}

void require_single_flight(const MissionSetup& mission) {
    if (mission.packs)
        throw InputError({mission.file}, "the mission has [packs], and this is computed for one flight alone",
                         "simulate, plan and report divide it, without options for one flight such as --samples, "
                         "--disturb and limits; for one flight leave [packs] out");
}

mechanical::PhysicalModel constant_cruise_power(const mechanical::MechanicalModel& model) {
    mechanical::PhysicalModel power;
    add_constant_power(mean_power_w(model.phases[Phase::cruise]), power);
    return power;
}

void set_cruise_path(MissionSetup& mission, path::PlannedPath plan) {
    const auto shared = std::make_shared<const path::PlannedPath>(std::move(plan));
    const auto flown = compute_trajectory(shared->path, shared->wind);
    mission.cruise_path = compute_cruise(shared, shared->wind, path::InfeasibleLegPolicy::refuse);
    mission.cruise_level = predicted_power(shared->power, mean_terms(shared->power, flown), flown.duration_s);
    mission.cruise_level->mean_w = mean_power_w(*mission.cruise_path);
    mission.duration_s[Phase::cruise] = duration_s(*mission.cruise_path);
    mission.duration_is_stated[Phase::cruise] = true;
}

double utility_per_s(const Utility& utility, const std::vector<double>& qos) {
    if (!utility.parameter) return utility.weight;
    const double q = qos.at(*utility.parameter);
    switch (utility.shape) {
        case UtilityShape::linear:
            return utility.weight * q;
        case UtilityShape::square_root:
            return utility.weight * std::sqrt(q);
        case UtilityShape::logarithm:
            return utility.weight * std::log1p(q);
        case UtilityShape::points:
            return utility.weight * interpolate_extended(utility.points_qos, utility.points_value, q);
    }
    throw std::logic_error("utility_per_s: no such shape");
}

double utility_per_s(const std::vector<std::optional<Utility>>& utilities,
                     const compute::Configuration& configuration) {
    double sum = 0.0;
    for (const auto& running : configuration) {
        if (running.component >= utilities.size() || !utilities[running.component]) continue;
        sum += utility_per_s(*utilities[running.component], running.qos);
    }
    return sum;
}

bool has_utility(const MissionSetup& mission) {
    return std::ranges::any_of(mission.utilities, [](const auto& u) { return u.has_value(); }) ||
           (mission.survey && mission.survey->utility);
}

std::optional<path::SurveyLayout> layout_of(const MissionSetup& mission) {
    return mission.survey ? std::optional(mission.survey->layout) : std::nullopt;
}

double coverage_utility(const MissionSetup& mission) {
    return mission.survey ? mission.survey->utility.value_or(0.0) : 0.0;
}

std::optional<double> mean_utility(const MissionSetup& mission, const Schedule& schedule, double until_s) {
    const auto& utilities = mission.utilities;
    if (!has_utility(mission)) return std::nullopt;
    const auto timeline = timeline_of(mission.duration_s);
    double sum = 0.0;
    for (const auto& segment : schedule) {
        const double phase_start_s = timeline.start_s[segment.phase];
        const double runs_s = std::min(phase_start_s + segment.end_s, until_s) - (phase_start_s + segment.start_s);
        if (runs_s > 0.0) sum += utility_per_s(utilities, segment.run) * runs_s;
    }
    const double part = std::min(until_s / timeline.duration_s, 1.0);
    return sum / timeline.duration_s + coverage_utility(mission) * part;
}

}  // namespace flightwatt::mission
