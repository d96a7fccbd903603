#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"
#include "mission/sampling/joint_spread.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// Number of quantities that differ between flights: level (mean power [W]) and duration [s] of take-off, then those of
/// cruise, then those of landing.
inline constexpr std::size_t phase_quantities = 2 * all_phases.size();
/// Returns the index of a phase's level among these quantities.
constexpr std::size_t level_index(Phase phase) { return 2 * static_cast<std::size_t>(phase); }
/// Returns the index of a phase's duration among these quantities.
constexpr std::size_t duration_index(Phase phase) { return level_index(phase) + 1; }

/// The standard deviation of a phase's mean mechanical power in a future flight from that of the model.
struct MeanPowerDeviation {
    double sd_w = 0.0;
    std::string basis = {};                    ///< its source, as text
    bool is_between_flights = false;           ///< false: it is unknown, or the standard error of the fit alone
    std::size_t flights = 0;                   ///< number of the model's flights, if it is by these
    double degrees_of_freedom = infinite_dof;  ///< of Student's t; infinite: normal
};

/// Returns the deviation of a phase's level by the first of these that the mission has: its [uncertainty]; the
/// deviations of the flights from the physical model; the standard deviation of the model's flights times sqrt(1 + sum
/// of their squared weights), that of a new flight from the mean of few; the standard error of the fit. Requires a
/// mechanical model.
MeanPowerDeviation level_deviation(const MissionSetup& mission, Phase phase);

/// Returns the mean mechanical power [W] of a phase of the mission. Requires a mechanical model.
double mean_level_w(const MissionSetup& mission, Phase phase);

/// Returns whether the variability between flights is known for each flown phase.
bool has_flight_variability(const MissionSetup& mission);

/// Returns whether the probabilities of drawn flights are known: for a mission with a mechanical model if that
/// variability is.
bool has_known_probability(const MissionSetup& mission);

/// Throws InputError unless has_flight_variability(). Requires a mechanical model.
void require_flight_variability(const MissionSetup& mission);

/// The spread of the power of one component between flights.
struct ComponentSpread {
    double common_sd_percent = 0.0;  ///< standard deviation common to all its nodes
    std::vector<double> node_sd_w;   ///< standard deviation of each node alone; or empty
};

/// The variability between the flights of a mission, for plans with a probability and drawn flights. Everything else is
/// equal in all flights: schedule, cut-off voltage, the shape of the power within a phase.
struct FlightUncertainty {
    PerPhase<double> level_sd_w;  ///< of the mean mechanical power of each phase
    PerPhase<double> duration_sd_s;
    std::vector<JointDistribution>
        joint;  ///< the quantities that are estimated from few flights instead of stated by the mission
    PerPhase<double> max_rise_w;              ///< limit of a drawn level above that of the mission
    std::vector<ComponentSpread> components;  ///< one for each component of the mission
    battery::BatteryIntervals battery;        ///< 95 % intervals of the values that differ
    UncertaintySources sources;
};

/// Returns the degrees of freedom of the mechanical energy of drawn flights, by Welch and Satterthwaite.
double energy_degrees_of_freedom(const MissionSetup& mission, const FlightUncertainty& spreads);

/// Returns the highest power [W] that a flight of the model had in any phase, by its curve or on average; infinite if
/// the model has neither.
double highest_measured_power_w(const mechanical::MechanicalModel& model);

/// Limit of drawn mean powers, as a multiple of the highest measured power.
inline constexpr double power_margin = 1.25;

/// Collects the variability of a mission: its [uncertainty], as normal deviations. Else mean powers have that of
/// level_deviation(), and durations, unless the mission states them, that of the model's flights in proportion, both by
/// Student's t with the correlations of the flights; computing has the standard errors of the profile's nodes; the
/// battery the 95 % intervals of its file, except for a capacity that the mission states.
FlightUncertainty collect_uncertainty(const MissionSetup& mission);

}  // namespace flightwatt::mission
