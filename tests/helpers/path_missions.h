#pragma once

#include "helpers/steady_mission.h"

#include <memory>
#include <utility>

namespace flightwatt::test {

/// An aircraft that takes 0.01 W s^3/m^3 of drag, 8 W a m/s of climb and what its turns add.
inline mechanical::PhysicalModel made_up_wing() {
    using mechanical::PowerTerm;
    mechanical::PhysicalModel model;
    model.terms = {PowerTerm::drag, PowerTerm::turn, PowerTerm::climb};
    model.coefficients[PowerTerm::drag] = 0.01;
    model.coefficients[PowerTerm::turn] = 40.0;
    model.coefficients[PowerTerm::climb] = 8.0;
    model.covariance.assign(3, std::vector<double>(3, 0.0));
    model.level_sd = 0.04;
    model.degrees_of_freedom = 5.0;
    model.drift_degrees_of_freedom = 50.0;
    model.airspeed_m_per_s = {11.0, 16.0};
    model.climb_m_per_s = {-2.0, 2.0};
    model.mean_airspeed_m_per_s = 13.0;
    return model;
}

inline mission::PathElement path_element(std::variant<mission::Leg, mission::Circles, mission::Hold> shape,
                                         double airspeed_m_per_s = 13.0, double altitude_change_m = 0.0) {
    mission::PathElement element;
    element.shape = shape;
    element.airspeed_m_per_s = airspeed_m_per_s;
    element.altitude_change_m = altitude_change_m;
    element.name = "leg";
    return element;
}

/// The steady mission's battery on a path, with nothing that runs.
inline mission::Mission path_mission(mission::FlightPath path, const mission::Wind& wind = {}) {
    auto mission = steady_mission();
    mission.mechanical->physical = made_up_wing();
    auto plan =
        std::make_shared<const mission::PlannedPath>(mission::PlannedPath{std::move(path), wind, made_up_wing()});
    mission.cruise_path = compute_cruise(plan, wind, mission::InfeasibleLegPolicy::refuse);
    mission.cruise_level = mechanical::ConstantPower{mean_power_w(*mission.cruise_path), std::nullopt, 0.0};
    const double cruise_s = duration_s(*mission.cruise_path);
    mission.duration_s[flight::Phase::cruise] = cruise_s;
    mission.duration_is_stated[flight::Phase::cruise] = true;
    mission.schedule = {{flight::Phase::cruise, 0.0, cruise_s, {}}};
    return mission;
}

}  // namespace flightwatt::test
