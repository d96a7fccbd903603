#pragma once

#include "base/statistics.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mechanical {

/// What carries a rotorcraft.
struct RotorLoading {
    double mass_kg = 0.0;  ///< without the payload
    double disc_area_m2 = 0.0;
};

struct AircraftLoad {
    double payload_kg = 0.0;                  ///< beyond the aircraft's own mass
    std::optional<RotorLoading> rotors = {};  ///< of a rotorcraft, if stated
};

/// The motion of an aircraft through the air.
struct FlightState {
    double airspeed_m_per_s = 0.0;
    double climb_m_per_s = 0.0;  ///< below 0 it descends
    double load_factor = 1.0;    ///< lift over weight: 1 / cos(bank) in a level turn
};

/// The terms of the power, each a coefficient times a value of the motion.
enum class PowerTerm {
    drag,      ///< V^3: form and friction drag
    induced,   ///< 1 / V: the drag of lift in straight flight
    turn,      ///< (n^2 - 1) / V: what a turn adds to it
    climb,     ///< climb rate, both ways: m g / efficiency
    descent,   ///< climb rate below 0, in addition to `climb`: a descent returns less
    constant,  ///< independent of the motion
    hover,     ///< weight times induced velocity (Glauert): what rotors of known loading spend on lift
    blade,     ///< V^2: what forward flight adds to the drag of rotor blades
    payload,   ///< payload: what it adds, in proportion
};

inline constexpr std::size_t power_term_count = 9;
inline constexpr std::array<PowerTerm, power_term_count> all_power_terms{
    PowerTerm::drag,     PowerTerm::induced, PowerTerm::turn,  PowerTerm::climb,  PowerTerm::descent,
    PowerTerm::constant, PowerTerm::hover,   PowerTerm::blade, PowerTerm::payload};

/// "drag" and so on, as model files call them.
std::string_view to_string(PowerTerm term);
std::optional<PowerTerm> power_term_from(std::string_view name);

/// The unit of a term's coefficient, "W s^3/m^3".
std::string_view unit_of(PowerTerm term);

/// A value for each term, indexed by PowerTerm.
struct TermValues {
    std::array<double, power_term_count> values{};
    double& operator[](PowerTerm term) { return values[static_cast<std::size_t>(term)]; }
    const double& operator[](PowerTerm term) const { return values[static_cast<std::size_t>(term)]; }
};

/// A motion for some time.
struct MotionAhead {
    TermValues mean_terms;
    double duration_s = 0.0;
};

/// The power of a hover grows with this power of the mass, by momentum theory.
inline constexpr double hover_exponent = 1.5;

/// Induced power [W] of level flight by momentum theory: weight times v, with v sqrt(V^2 + v^2) = weight / (2 density
/// area) (Glauert) at sea level. 0 without rotors.
double induced_power_w(const AircraftLoad& load, double airspeed_m_per_s);

/// The terms' values. Below 1 m/s no wing carries: induced drag and that of turns are those of 1 m/s. Throws
/// std::invalid_argument unless airspeed and load factor are at least 0.
TermValues term_values(const FlightState& motion, const AircraftLoad& load = {});

/// Coefficients for the speed to fly: of a model's terms with drag and induced drag, also where their fit predicts no
/// better (docs/methods.md, Speed to fly).
struct SpeedTerms {
    std::vector<PowerTerm> terms;
    TermValues coefficients;
    std::vector<std::vector<double>> covariance;
    double degrees_of_freedom = 0.0;  ///< 0: of a single flight, without intervals
};

/// Mechanical power from the motion through the air, fitted to flights of one aircraft:
///     power(t) = (1 + level) * sum over the terms of coefficient * value  +  drift(t)       [W]
/// level: of a flight, the same throughout; drift: within a flight, with exponential correlation.
struct PhysicalModel {
    std::vector<PowerTerm> terms;                 ///< of the model
    TermValues coefficients;                      ///< 0 for other terms
    std::vector<std::vector<double>> covariance;  ///< of the coefficients of `terms`, in their order

    /// Standard deviation of a flight's level, relative to its power: the scale of a Student's t with
    /// `degrees_of_freedom`. Absent for a single flight.
    std::optional<double> level_sd;
    double degrees_of_freedom = 0.0;

    double drift_sd_w = 0.0;     ///< of means over bin_s
    double correlation_s = 1.0;  ///< of the drift
    double drift_degrees_of_freedom = 1.0;

    double bin_s = 0.0;  ///< the time over which power and motion were averaged for the fit
    std::size_t bins = 0;
    std::size_t samples = 0;  ///< of power, in the bins
    std::vector<std::string> flights;

    Interval airspeed_m_per_s;  ///< of the bins' means
    /// Error of these means (1 sd) in flights without an airspeed sensor; absent if all measured it.
    std::optional<double> airspeed_sd_m_per_s = {};
    Interval climb_m_per_s;
    /// Of which power is predicted; after a fit with the mean payload of its flights.
    AircraftLoad load = {};
    std::optional<Interval> payload_kg = {};  ///< of the flights; absent unless all state theirs
    double mean_airspeed_m_per_s = 0.0;       ///< of the flights' cruises, each counting the same
    /// The root of their mean cube, at which drag takes its mean power; absent in files of 0.2.
    std::optional<double> cubic_mean_airspeed_m_per_s = {};
    /// Standard deviation of the airspeeds of the bins in cruise, without gusts; absent in older files.
    std::optional<double> airspeed_spread_m_per_s = {};
    /// Absent where `terms` contain drag and induced drag or the flights do not determine them, and in older files.
    std::optional<SpeedTerms> speed_terms = {};
};

/// The power of a motion [W], 0 where the terms sum to less: the motor does not regenerate energy. Throws as
/// term_values.
double power_w(const PhysicalModel& model, const FlightState& motion);

/// The sum of the terms [W], which may be below 0: the means over a time of the terms give the mean power.
double sum_of_terms_w(const PhysicalModel& model, const TermValues& values);

/// Adds a power that does not depend on the motion.
void add_constant_power(double power_w, PhysicalModel& model);

/// Where a model has a term for induced drag and none for turns, gives turns its coefficient: induced drag grows with the
/// square of the lift.
void add_turns_of_induced_drag(PhysicalModel& model);

/// The variance [W^2] of that sum by the coefficients' covariance.
double coefficient_variance_w2(const PhysicalModel& model, const TermValues& values);

/// A mean power and its uncertainty.
struct ConstantPower {
    double mean_w = 0.0;
    std::optional<double> sd_w;       ///< of a flight's mean power about it, its own error included
    double degrees_of_freedom = 0.0;  ///< of the Student's t that makes intervals of sd_w
};

/// A stationary deviation with exponential correlation (Ornstein-Uhlenbeck):
/// covariance(t, t + lag) = sd^2 exp(-lag / correlation_s) (docs/methods.md, Eqs. 17 and 18).
struct DriftProcess {
    double sd_w = 0.0;
    double correlation_s = 1.0;
};

/// Variance [W^2] of the mean over `duration_s` (docs/methods.md, Eq. 17).
double variance_of_mean_w2(const DriftProcess& drift, double duration_s);

/// Length of a bin: longer than gusts and the exchange of height and speed, shorter than manoeuvres.
inline constexpr double default_bin_s = 30.0;

/// A physical model needs as many bins.
inline constexpr std::size_t min_bins = 10;

/// Shorter bins weigh in proportion, as gusts and manoeuvres do not average out over them.
inline double weight_of_bin(double duration_s) { return std::min(1.0, duration_s / default_bin_s); }

/// Variance [W^2] of the model's drift as the mean over `duration_s`, which may be less than a bin.
double drift_variance_w2(const PhysicalModel& model, double duration_s);

/// Covariance [W^2] of the means over two durations, the second of which follows the first.
double covariance_of_means_w2(const DriftProcess& drift, double first_s, double second_s);

/// A new flight's mean power over `duration_s` with these mean values of the terms, not below 0; its uncertainty is of
/// level, drift and coefficients (docs/methods.md, Power from airspeed and climb), and absent for a single flight's model.
ConstantPower predicted_power(const PhysicalModel& model, const TermValues& mean_values, double duration_s);

/// Returns the airspeed up to which power may be predicted [m/s]: any with a term for drag, which grows with the airspeed.
/// Without one a quarter more than flown, or 8 m/s, up to which level flight takes a rotorcraft about as much as hover
/// does: by momentum theory it saves at most what its drag then costs.
double max_predicted_airspeed_m_per_s(const PhysicalModel& model);

/// Returns the airspeed down to which power may be predicted [m/s]: the least that was flown of a wing whose model has no
/// term for induced drag, which rises as it flies slower; else 0.
double min_predicted_airspeed_m_per_s(const PhysicalModel& model, bool is_rotorcraft);

/// Returns whether the model's flights show what airspeed costs: the model has a term for drag, or for that of blades.
bool knows_cost_of_airspeed(const PhysicalModel& model);

/// Whether a climb or descent is at most 0.5 m/s, as gusts make it in level flight, or half more than flown.
bool is_near_flown_climb(const PhysicalModel& model, double climb_m_per_s);

/// Whether the model may predict the power of a motion: of an airspeed within both of these, at which level flight takes
/// at most twice and at least half of the power at the ends of what was flown, and of such a climb.
bool may_predict_power(const PhysicalModel& model, const FlightState& motion, bool is_rotorcraft);

/// Whether the motion is within the range of the model's flights.
bool is_within_flown_range(const PhysicalModel& model, const FlightState& motion);

/// A term that the fit tried, and the result.
struct TermTrial {
    PowerTerm term = PowerTerm::drag;
    bool kept = false;
    std::optional<double> rms_before_w;  ///< hold-out error without the term; absent if it was not tried
    std::optional<double> rms_after_w;   ///< and with it
    std::string reason;                  ///< why it was dropped, or could not be tried; empty if it was kept
};

}  // namespace flightwatt::mechanical
