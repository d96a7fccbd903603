#pragma once

#include "flight/flight_phases.h"
#include "mechanical/physical_model.h"
#include "mechanical/speed_to_fly.h"
#include "path/path.h"
#include "path/trajectory.h"
#include "path/turns.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::path {

/// The mechanical power of a phase, constant between times, as the energy up to each time since its start. The first
/// time is 0 s, with an energy of 0.
struct PiecewisePower {
    std::vector<double> time_s{0.0};
    std::vector<double> energy_j{0.0};
};

/// The path and wind of a cruise, and the model of its power.
struct PlannedPath {
    FlightPath path;  ///< as it is flown
    Wind wind;
    mechanical::PhysicalModel power;
    std::optional<TurnLimits> turns = std::nullopt;             ///< absent: the path is flown as it is drawn
    FlightPath drawn = {};                                      ///< the path without the turns, if there are limits
    std::optional<PathOrigin> origin = std::nullopt;            ///< absent: in metres from an unknown place
    std::optional<double> start_above_ground_m = std::nullopt;  ///< height of its start above home, if it is known
    ClimbRates rates = {};    ///< of further ways: those of the path, else of the model's flights
    bool is_of_vtol = false;  ///< the plan that is flown takes off and lands as a VTOL
};

/// Returns the path without its turns.
inline const FlightPath& drawn_path(const PlannedPath& plan) { return plan.turns ? plan.drawn : plan.path; }

/// Returns another path with the turns of the plan in its wind.
FlightPath as_flown(const PlannedPath& plan, FlightPath drawn);

/// A cruise whose power follows from a path instead of a curve over time. Copies are cheap.
struct CruisePath {
    std::shared_ptr<const PlannedPath> plan;
    std::shared_ptr<const PiecewisePower> pieces;  ///< one or more
    bool is_infeasible = false;                    ///< a drawn wind forbids the path: the flight fails
};

/// Computes a cruise as it is flown in `wind`, its power times `factor`. Throws as compute_trajectory().
CruisePath compute_cruise(std::shared_ptr<const PlannedPath> plan, const Wind& wind,
                          InfeasibleLegPolicy infeasible_legs, double factor = 1.0);

/// Returns the duration of a cruise.
double duration_s(const CruisePath& cruise);
/// Returns the mechanical energy of a cruise.
double energy_j(const CruisePath& cruise);
/// Returns the mean mechanical power of a cruise.
double mean_power_w(const CruisePath& cruise);

/// One element of a path as it is flown, with means over its time.
struct PathElementResult {
    std::string name;      ///< "leg 3"
    std::string kind;      ///< "leg", "circles", "turn" or "hold"
    double start_s = 0.0;  ///< since the cruise began
    double duration_s = 0.0;
    std::optional<double> length_m;  ///< length over ground
    std::optional<double> course_deg;
    double airspeed_m_per_s = 0.0;
    double climb_m_per_s = 0.0;
    double load_factor = 1.0;  ///< root of its mean square
    double mechanical_w = 0.0;
};
/// Returns the result of each element of a path in the plan's wind.
std::vector<PathElementResult> path_element_results(const PlannedPath& plan);

/// Returns the mean of each term of the power over the cruise, weighted by time, for predicted_power(). While the motor
/// is off (power_w is 0) the terms count as zeros, so that their power is the mean power. Zeros for a path that takes
/// no time.
mechanical::TermValues mean_terms(const mechanical::PhysicalModel& model, const PathTrajectory& flown);

/// The common airspeed of all elements at which a path takes the least energy in its wind, and the energy as planned by
/// the same model. Measured times and climb rates are kept.
struct PathSpeed {
    mechanical::BestSpeed best;
    double planned_wh = 0.0;
};

/// Finds the best airspeed of a path; std::nullopt if mechanical::speed_model() has none. Throws as
/// compute_trajectory().
std::optional<PathSpeed> best_path_speed(const PlannedPath& plan);

/// Returns whether a turn takes a bank above 60 degrees, which the aircraft may not be able to fly.
bool has_steep_turn(const PathTrajectory& flown);

/// Returns the part of the time that is flown far beyond the airspeeds and climbs of the model's flights, 0 to 1.
double part_far_beyond(const PlannedPath& plan, const PathTrajectory& flown);

/// Returns warnings about the first element outside of the model's flown range, and about a steep turn.
std::vector<std::string> path_warnings(const PlannedPath& plan, const PathTrajectory& flown);

}  // namespace flightwatt::path
