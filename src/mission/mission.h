#pragma once

#include "base/statistics.h"
#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"
#include "mission/schedule.h"
#include "path/area.h"
#include "path/cruise_path.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flightwatt::mission {

/// How the utility grows with the quality of service q. All are monotone.
enum class UtilityShape {
    linear,       ///< q
    square_root,  ///< sqrt(q)
    logarithm,    ///< ln(1 + q): 0 at 0
    points        ///< straight lines between given points
};

/// The utility of a component's quality of service a second while it runs: weight * shape(q). A component that
/// is off has none.
struct Utility {
    std::optional<std::size_t> parameter;  ///< of the profile; none: the weight itself, whenever it runs
    double weight = 1.0;
    UtilityShape shape = UtilityShape::linear;
    std::vector<double> points_qos;    ///< rising, around the profile's whole range; only of `points`
    std::vector<double> points_value;  ///< not falling, as many
};

/// Standard deviations between flights as stated by a mission; without them see collect_uncertainty.
struct Uncertainty {
    PerPhase<std::optional<double>> level_sd_percent;  ///< of the phase's mean mechanical power
    PerPhase<std::optional<double>> duration_sd_s;
    std::vector<std::optional<double>> compute_sd_percent;  ///< of each component's power
    std::optional<double> capacity_sd_percent;              ///< of the battery's capacity
    double initial_soc_sd_percent = 0.0;                    ///< of the charge at the start [points]
};

/// Name of the leg by which a flight with one of several packs leaves the path.
inline constexpr auto way_home = "way home";

/// Packs that are changed on the ground: the mission is as many flights as it needs (packs.h).
struct Packs {
    std::size_t count = 1;
    double change_s = 0.0;                         ///< on the ground, for each change
    std::vector<battery::Battery> batteries = {};  ///< one a pack; empty: all are the mission's
    path::LocalPosition home = {};                 ///< from the start of the path
};

/// A line of a survey in the cruise.
struct SurveyLineTime {
    double start_s = 0.0;  ///< with the turn before it, since the cruise began
    double end_s = 0.0;
    double to = 0.0;  ///< part of the area's width up to which it covers, in the order of flight
};

/// How the lines of a path cover its area.
struct SurveyCoverage {
    path::SurveyLayout layout;
    bool is_chosen = false;  ///< with the schedule, and not stated by the mission
    std::vector<SurveyLineTime> lines = {};
    double coverage = 0.0;  ///< how often a place of the area is seen on average; 0 if the sensor's width is not stated
    /// Mean over the area of weight * shape(coverage): a utility a second as those of components, as long as the
    /// mission takes. Absent: none is stated.
    std::optional<double> utility = {};
    bool has_zones = false;  ///< holes or zones that are not to be flown over
};

/// What the powers of a mission rest on, where a payload changes those of its model's flights.
struct PayloadBasis {
    double payload_kg = 0.0;
    bool is_assumed = false;  ///< and not what the flights show
    std::string text;         ///< "its power is assumed to be ..."
};

/// A flight, the software that can run in it, and the battery that feeds both: all but the schedule.
struct MissionSetup {
    std::string file;
    std::string name;
    std::optional<mechanical::MechanicalModel> mechanical;  ///< none: computing alone
    mechanical::PhaseTimeScaling phase_clock = mechanical::PhaseTimeScaling::scaled;
    std::optional<double> airspeed_m_per_s = {};  ///< of the cruise, if stated
    /// The cruise's mean power at the stated airspeed, or along its path; the cruise has this level then.
    std::optional<mechanical::ConstantPower> cruise_level = {};
    std::optional<SurveyCoverage> survey = {};         ///< of a path over an area
    std::optional<path::CruisePath> cruise_path = {};  ///< source of the cruise's power instead of the model's curve
    /// Measured power of each phase in a replay, instead of the power by model and path.
    PerPhase<std::shared_ptr<const path::PiecewisePower>> measured_power = {};
    PerPhase<double> duration_s;        ///< 0: the phase is not flown
    PerPhase<bool> duration_is_stated;  ///< by the mission, and not its model's: all flights take so long
    battery::Battery battery;
    bool capacity_is_stated = false;  ///< by the mission, and not its battery's: all packs hold so much
    bool may_charge = false;          ///< power below 0 is meant, and charges the battery
    compute::ComputeModel compute;
    std::vector<std::optional<Utility>> utilities;  ///< one a component (or none at all)
    double initial_soc_percent = 100.0;
    double cutoff_voltage_v = 0.0;     ///< the battery is cut off below it; 0: never
    double reserve_soc_percent = 0.0;  ///< what should be left at the end
    Uncertainty uncertainty;
    std::optional<mechanical::HeldOutScore> power_model =
        {};                                    ///< of the model that predicts the power, if its file has a validation
    std::vector<std::string> notes = {};       ///< warnings from reading the file
    std::vector<std::string> uncertain = {};   ///< reasons why the result may be wrong, which no probability covers
    std::optional<PayloadBasis> payload = {};  ///< absent: the powers are those of the model's flights
    std::optional<Packs> packs = {};           ///< then it is divided (packs.h) before anything flies it
};

/// A mission that can be flown.
struct Mission {
    MissionSetup setup;
    Schedule schedule;  ///< in order, covers each instant of each phase exactly once
};

/// Choices of a planner for one component.
struct ComponentChoices {
    std::vector<std::vector<double>> levels;  ///< of each parameter; every combination may be chosen
    bool may_be_off = false;
};

/// How a mission's schedule may be planned.
struct PlanSettings {
    double slot_s = 10.0;                          ///< QoS may change at its multiples, counted from each phase's start
    double dwell_s = 0.0;                          ///< minimum duration of a configuration
    std::vector<ComponentChoices> choices;         ///< one a component
    PerPhase<double> slot_scale{{1.0, 1.0, 1.0}};  ///< of slot_s, where a phase takes another time than was planned
};

/// How a schedule is made in flight (see simulate_adaptive).
struct AdaptivePolicy {
    double decide_every_s = 0.0;  ///< of each phase; by default the slot of the plan
    /// How far flights' mechanical power is expected from the model's; by default as its flights differ.
    std::optional<double> mechanical_sd_percent = {};
    double learning_time_s = 60.0;  ///< after it, observation and prior have equal weight
    double probability = 0.95;      ///< with which the reserve is to be kept, of every decision
};

struct PlanningProblem;

/// The ways to cover the area of a path that a plan may choose between: for each block of equal width one of the
/// levels, and one course of all.
struct SurveyChoices {
    std::vector<double> headings_deg;
    std::vector<path::SurveyStrip> levels;  ///< spacing and airspeed; `to` is not used
    std::size_t blocks = 1;
    /// The mission with one of them. Throws InputError where its path cannot be flown. May be called by several threads.
    std::function<PlanningProblem(const path::SurveyLayout&)> mission_with;
};

/// A mission whose schedule is yet to be made.
struct PlanningProblem {
    MissionSetup setup;
    Schedule fixed;  ///< in order: the segments scheduled by the mission
    PlanSettings plan;
    std::optional<AdaptivePolicy> adaptive;  ///< the schedule is made in flight, again and again
    /// If the lines over an area are chosen with the schedule; `setup` and `fixed` are then of one of the choices.
    std::shared_ptr<const SurveyChoices> survey = {};
};

/// Content of a mission file.
using MissionVariant = std::variant<Mission, PlanningProblem>;

/// The mission with another value of one of its numbers, such as the length of its cruise [s]. May throw InputError
/// where its schedule does not fit.
using MissionVariation = std::function<MissionVariant(double value)>;

const MissionSetup& setup_of(const MissionVariant& mission);

/// Throws InputError for a mission over several packs: it is divided before anything flies it.
void require_single_flight(const MissionSetup& mission);

/// Returns a model of the power whatever the motion: the mean of the model's cruise.
mechanical::PhysicalModel constant_cruise_power(const mechanical::MechanicalModel& model);

/// Makes the cruise of a path: its duration, and its level and power by the physical model. Throws as
/// compute_trajectory.
void set_cruise_path(MissionSetup& mission, path::PlannedPath plan);

/// Half the width of a normal 95 % interval, in deviations.
inline constexpr double sd_per_half_95 = 1.96;

/// 95 % interval of the capacity over flights: by [uncertainty], else by the battery's file. None where the mission
/// states the capacity without a deviation, or both lack it.
std::optional<Interval> capacity_interval_ah(const MissionSetup& mission);

double utility_per_s(const Utility& utility, const std::vector<double>& qos);

/// The utility of a configuration a second: the sum over the components that run and have a utility.
/// `utilities` has one entry a component of the model (or none at all).
double utility_per_s(const std::vector<std::optional<Utility>>& utilities, const compute::Configuration& configuration);

/// Whether a component or the coverage of an area has a utility.
bool has_utility(const MissionSetup& mission);

/// The lines over the area of a path; none without one.
std::optional<path::SurveyLayout> layout_of(const MissionSetup& mission);

/// The utility a second of how the area is covered; 0 without one.
double coverage_utility(const MissionSetup& mission);

/// Mean utility a second of a schedule and of the coverage up to `until_s` [mission time], over the duration of the
/// whole mission; none if the mission states no utility.
std::optional<double> mean_utility(const MissionSetup& mission, const Schedule& schedule, double until_s);

}  // namespace flightwatt::mission
