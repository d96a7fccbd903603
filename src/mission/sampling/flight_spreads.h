#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mission {

/// Degrees of freedom of a known standard deviation: Student's t is then normal.
inline constexpr double infinite_dof = std::numeric_limits<double>::infinity();

/// No number of Student's t is drawn further out: with one degree of freedom, 6 of 10 million would be.
inline constexpr double max_student = 1e6;

/// The quantile of Student's t with the same tail probability as `normal` of a standard normal.
double student_from_normal(double normal, double degrees_of_freedom);

/// The standard normal numbers as numbers of the multivariate Student t with covariance structure 1: each is Student t,
/// so is any weighted sum of them (in the root of the squares' sum), and they are far out together, since all are in
/// units of one deviation that is estimated. One after the other, each given those before (docs/methods.md, Eq. 31).
std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom);

/// Returns the 95 % interval of the part of new flights that is beyond a threshold, where between `drawn.low` and
/// `drawn.high` of the flights drawn by Student's t are: drawn flights average over all spreads that few flights allow,
/// and new flights have one of them (docs/methods.md, Eq. 31a).
Interval interval_of_share(const Interval& drawn, double degrees_of_freedom);

/// What differs between the phases of flights: levels [W] and durations [s], numbered level and duration of take-off,
/// those of cruise, those of landing.
inline constexpr std::size_t phase_quantities = 2 * all_phases.size();
constexpr std::size_t level_index(Phase phase) { return 2 * static_cast<std::size_t>(phase); }
constexpr std::size_t duration_index(Phase phase) { return level_index(phase) + 1; }

/// How one of them differs, as few flights show.
struct EstimatedSpread {
    std::size_t quantity = 0;
    double sd = 0.0;  ///< of a flight to come
    double degrees_of_freedom = 1.0;
    std::vector<std::optional<double>> of_flights;  ///< the quantity itself in each of the model's flights
};

/// Quantities that rest on as many flights, and are drawn together.
struct JointDistribution {
    double degrees_of_freedom = 1.0;
    std::vector<std::size_t> quantities;  ///< rising
    Eigen::MatrixXd factor;               ///< the quantities' deviations, in their order, are this times student_vector
};

/// Spreads of as many degrees of freedom together, with the correlations that the flights show which have all that is
/// known of any. Quantities known of less than two flights are uncorrelated.
std::vector<JointDistribution> estimate_joint_distributions(const std::vector<EstimatedSpread>& spreads);

/// True of a spread that `spreads` draws by how it went together with the others of its flights.
bool is_known_of_flights(const EstimatedSpread& spread);

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
    std::vector<JointDistribution> of_flights;  ///< those of them that few flights show, and not the mission states
    PerPhase<double> max_rise_w;                ///< a level is drawn no further above the mission's
    std::vector<ComponentSpread> components;    ///< one a component of the mission
    battery::BatteryIntervals battery;          ///< 95 % intervals of what differs
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
