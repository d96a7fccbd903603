#pragma once

#include "flight/flight_phases.h"
#include "mechanical/physical_model.h"
#include "mechanical/speed_to_fly.h"
#include "path/path.h"
#include "path/trajectory.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::path {

/// Mechanical power of a phase, constant between times since its start: the energy up to each time, 0 at the first, 0
/// s.
struct PiecewisePower {
    std::vector<double> time_s{0.0};
    std::vector<double> energy_j{0.0};
};

/// Where a cruise is flown, in which wind, and what its motion takes.
struct PlannedPath {
    FlightPath path;
    Wind wind;
    mechanical::PhysicalModel power;
};

/// A cruise whose power follows from a path, and not from a curve over time. Copies are cheap.
struct CruisePath {
    std::shared_ptr<const PlannedPath> plan;
    std::shared_ptr<const PiecewisePower> pieces;  ///< one or more
    bool is_infeasible = false;                    ///< by a wind that was drawn: the flight fails
};

/// A cruise as it is flown in `wind`, its power times `factor`. Throws as compute_trajectory.
CruisePath compute_cruise(std::shared_ptr<const PlannedPath> plan, const Wind& wind,
                          InfeasibleLegPolicy infeasible_legs, double factor = 1.0);

double duration_s(const CruisePath& cruise);
double energy_j(const CruisePath& cruise);
double mean_power_w(const CruisePath& cruise);

/// One element of a path as it is flown: means over its time.
struct PathElementResult {
    std::string name;      ///< "leg 3"
    std::string kind;      ///< "leg", "circles" or "hold"
    double start_s = 0.0;  ///< since the cruise began
    double duration_s = 0.0;
    std::optional<double> length_m;  ///< over ground
    std::optional<double> course_deg;
    double airspeed_m_per_s = 0.0;
    double climb_m_per_s = 0.0;
    double load_factor = 1.0;  ///< the root of the mean square
    double mechanical_w = 0.0;
};
std::vector<PathElementResult> path_element_results(const PlannedPath& plan);

/// The mean of each term of the power over the cruise, weighted by time: what predicted_power wants. Where the
/// motor stands (power_w is 0) the terms count as zeros, so that their power is the mean power. Zeros for a path that
/// takes no time.
mechanical::TermValues mean_terms(const mechanical::PhysicalModel& model, const PathTrajectory& flown);

/// One airspeed for all elements at which a path takes the least energy in its wind, and the energy as planned, by the
/// same model. Measured times and climb rates are kept.
struct PathSpeed {
    mechanical::BestSpeed best;
    double planned_wh = 0.0;
};

/// std::nullopt as mechanical::speed_model. Throws as compute_trajectory.
std::optional<PathSpeed> best_path_speed(const PlannedPath& plan);

/// Warnings of the first element outside of the model's flown range, and of a bank above 60 degrees.
std::vector<std::string> path_warnings(const PlannedPath& plan, const PathTrajectory& flown);

}  // namespace flightwatt::path
