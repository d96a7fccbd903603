#pragma once

#include "path/cruise_path.h"
#include "path/path.h"

#include <memory>
#include <utility>
#include <variant>
#include <vector>

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

inline path::PathElement path_element(std::variant<path::Leg, path::Circles, path::Hold> shape,
                                      double airspeed_m_per_s = 13.0, double altitude_change_m = 0.0) {
    path::PathElement element;
    element.shape = shape;
    element.airspeed_m_per_s = airspeed_m_per_s;
    element.altitude_change_m = altitude_change_m;
    element.name = "leg";
    return element;
}

/// The path as that aircraft flies it.
inline path::CruisePath made_up_cruise(path::FlightPath path, const path::Wind& wind = {}) {
    auto plan = std::make_shared<const path::PlannedPath>(path::PlannedPath{std::move(path), wind, made_up_wing()});
    return compute_cruise(std::move(plan), wind, path::InfeasibleLegPolicy::refuse);
}

}  // namespace flightwatt::test
