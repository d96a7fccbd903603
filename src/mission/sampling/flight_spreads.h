#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"
#include "mission/sampling/joint_spread.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// What differs between the phases of flights: levels [W] and durations [s], numbered level and duration of take-off,
/// those of cruise, those of landing.
inline constexpr std::size_t phase_quantities = 2 * all_phases.size();
constexpr std::size_t level_index(Phase phase) { return 2 * static_cast<std::size_t>(phase); }
constexpr std::size_t duration_index(Phase phase) { return level_index(phase) + 1; }

/// Standard deviation of a phase's mean mechanical power about the model's, of a future flight.
struct MeanPowerDeviation {
    double sd_w = 0.0;
    std::string basis = {};                    ///< for people
    bool is_between_flights = false;           ///< else it is unknown, or the standard error of the fit alone
    std::size_t flights = 0;                   ///< of the model, if it is by these
    double degrees_of_freedom = infinite_dof;  ///< of its Student t; infinite: normal
};

/// By the first of these that the mission has: [uncertainty], the deviations of the flights from the physical model,
/// the standard deviation of the model's flights times sqrt(1 + sum of their squared weights), as of a new flight about
/// an average of few, the standard error of the fit. Needs a mechanical model.
MeanPowerDeviation level_deviation(const MissionSetup& mission, Phase phase);

/// The mean mechanical power [W] of a phase, as the mission has it. Needs a mechanical model.
double mean_level_w(const MissionSetup& mission, Phase phase);

/// Whether the variability between flights is known for each flown phase.
bool has_flight_variability(const MissionSetup& mission);

/// Whether the probabilities of drawn flights are known: of a mission with a mechanical model by that variability.
bool has_known_probability(const MissionSetup& mission);

/// Throws InputError unless it is. Needs a mechanical model.
void require_flight_variability(const MissionSetup& mission);

/// How the power of one component differs between flights.
struct ComponentSpread {
    double common_sd_percent = 0.0;  ///< of all its nodes together
    std::vector<double> node_sd_w;   ///< of each by itself; or empty
};

/// Variability between the flights of a mission, for plans with a probability and drawn flights. All else is equal in
/// every flight: schedule, cut-off voltage, the shape of the power within a phase.
struct FlightUncertainty {
    PerPhase<double> level_sd_w;  ///< of a phase's mean mechanical power
    PerPhase<double> duration_sd_s;
    std::vector<JointDistribution> joint;     ///< those of them that few flights show, and not the mission states
    PerPhase<double> max_rise_w;              ///< a level is drawn no further above the mission's
    std::vector<ComponentSpread> components;  ///< one a component of the mission
    battery::BatteryIntervals battery;        ///< 95 % intervals of what differs
    UncertaintySources sources;
};

/// Returns the degrees of freedom of the mechanical energy of drawn flights, by Welch and Satterthwaite.
double energy_degrees_of_freedom(const MissionSetup& mission, const FlightUncertainty& spreads);

/// The highest power [W] that a flight of the model had in any phase, by its curve or on average; infinite where the
/// model keeps neither.
double highest_measured_power_w(const mechanical::MechanicalModel& model);

/// Drawn mean powers are limited to 1.25 times the highest measured power.
inline constexpr double power_margin = 1.25;

/// The mission's [uncertainty], as normal deviations. Else: mean powers by level_deviation, and durations in proportion
/// to those of the model's flights unless the mission states them, both by Student's t with the correlations of the
/// flights; computing by the standard errors of the profile's nodes; the battery by the 95 % intervals of its file, but
/// not a capacity that the mission states.
FlightUncertainty collect_uncertainty(const MissionSetup& mission);

}  // namespace flightwatt::mission
