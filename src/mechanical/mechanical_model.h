#pragma once

#include "base/statistics.h"
#include "flight/flight_phases.h"
#include "mechanical/physical_model.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mechanical {

/// Mechanical power of one phase (Eq. 1), t in the phase's own time [s], omega = 1/xi of the equation:
///     f(t) = a0 + sum_{n=1..order} a_n cos(n omega t) + b_n sin(n omega t)      [W]
struct FourierModel {
    double omega_rad_per_s = 0.0;
    double a0_w = 0.0;
    std::vector<double> cos_w;  ///< a_1 .. a_order
    std::vector<double> sin_w;  ///< b_1 .. b_order, as long as cos_w
};

/// f(t) [W] at `time_s` since the phase began.
double power_w(const FourierModel& model, double time_s);

/// The integral of f from 0 to `time_s` [J], in closed form.
double energy_j(const FourierModel& model, double time_s);

/// The admissible frequencies of a fit, as omega * duration [rad].
struct FrequencyRange {
    double low_rad = 0.0;   ///< below, the basis becomes collinear
    double high_rad = 0.0;  ///< above, the third harmonic is faster than the samples
};

/// Of a value with this standard error, by Student's t.
Interval student_t_interval(double value, double standard_error, double degrees_of_freedom);

/// 95 % intervals of a phase's coefficients.
struct CoefficientIntervals {
    Interval omega_rad_per_s;
    Interval a0_w;
    std::vector<Interval> cos_w;
    std::vector<Interval> sin_w;
};

/// Standard errors of a phase's averaged coefficients from the noise of the samples, approximate: of the weighted mean
/// of these flights, with weights and durations given, at all admissible frequencies (analyse_errors). For the
/// differences between flights see FlightEnvelope.
struct PhaseErrors {
    double omega_rad_per_s = 0.0;
    double a0_w = 0.0;
    std::vector<double> cos_w;
    std::vector<double> sin_w;
    double curve_w = 0.0;             ///< root mean square over the phase of the curve's own standard error
    double degrees_of_freedom = 0.0;  ///< of their Student's t
    /// The errors are conditional on the frequency: the curve is a constant, or (in files of 0.2) at a bound.
    bool frequency_is_fixed = false;
    double r2 = 0.0;                 ///< of all samples about their own flights' curves and means
    double autocorrelation = 0.0;    ///< of neighbouring residuals
    double effective_samples = 0.0;  ///< independent samples with the same information on the mean
};

/// Variability of the flights' own curves over the phase, at evenly spread fractions of it from begin to end.
struct FlightEnvelope {
    std::vector<double> low_w;                 ///< the least of the flights that count (the paper's grey band)
    std::vector<double> high_w;                ///< the greatest of them
    std::vector<double> standard_deviation_w;  ///< of one flight about the weighted mean
    double effective_flights = 0.0;            ///< 1 / sum of squared weights
};

/// Variability of one phase between and within flights, for the interval of a prediction.
struct VarianceComponents {
    std::size_t flights = 0;           ///< 2 or more
    double between_flight_sd_w = 0.0;  ///< of the flights' mean powers
    double drift_sd_w = 0.0;           ///< of the power about the curve at the flight's own level
    double correlation_s = 0.0;        ///< of that deviation (exponential correlation)
};

struct PhaseModel;

/// The coefficients' intervals by Student's t, that of the frequency within its range. The phase must have errors.
CoefficientIntervals coefficient_intervals(const PhaseModel& phase);

/// How missions and predictions take the power of a phase.
enum class PowerBasis {
    curve,  ///< the Fourier series
    mean    ///< the flights' mean power
};

constexpr std::string_view to_string(PowerBasis power) { return power == PowerBasis::mean ? "mean" : "curve"; }

/// The decision on a phase's power, made when the model is fitted (decide_power).
struct PowerDecision {
    PowerBasis by = PowerBasis::curve;
    std::string reason = {};  ///< empty: nothing was decided, as in published models
};

/// Heights above the ground that the take-offs of a model's flights climbed to, or their landings descended from.
struct PhaseHeights {
    double mean_m = 0.0;  ///< weighted as the duration
    double low_m = 0.0;
    double high_m = 0.0;
    double m_per_s = 0.0;  ///< rate at which a height beyond the mean is climbed or descended
};

/// One phase of the model: the flights' weighted average (Eqs. 5-7) and its basis.
struct PhaseModel {
    FourierModel fourier;
    double duration_s = 0.0;      ///< weighted average duration
    std::optional<double> rms_w;  ///< residual of the flights' own curves; absent if published without
    std::optional<FrequencyRange> range;
    std::size_t samples = 0;
    std::size_t flights = 0;
    std::size_t edge_samples = 0;  ///< excluded at the phase's ends: their power is the neighbouring phase's
    bool open_frequency = false;   ///< other frequencies fit almost as well: the coefficients describe this curve only
    bool not_negative =
        false;  ///< the harmonics were reduced, as the curve fell below 0, or below negative power measured
    std::optional<PhaseErrors> errors = {};     ///< absent unless they were asked for
    std::optional<FlightEnvelope> spread = {};  ///< absent too where a single flight counts
    /// Absent with fewer than 2 flights, or if published without.
    std::optional<VarianceComponents> level_spread = {};  ///< its drift is about what predicts the phase
    PowerDecision power = {};
    std::optional<PhaseHeights> heights = {};  ///< absent of the cruise, and in files of 0.2
};

/// Returns the mean of the phase's curve over its duration [W]; 0 without a duration.
double mean_power_w(const PhaseModel& phase);

/// Returns how long a take-off to this height, or a landing from it, takes at the rate of the phase's flights; none
/// shorter than from the least height that was flown. The phase must have heights.
double duration_at_height_s(const PhaseModel& phase, double height_m);

/// One flight's part in one phase.
struct PhaseContribution {
    double weight = 0.0;  ///< in [0, 1]; the flights' weights of a phase sum to 1
    double duration_s = 0.0;
    double rms_w = 0.0;
    std::size_t samples = 0;
    std::optional<double> mean_power_w = {};  ///< absent if published without
};

struct FlightContribution {
    std::string flight;
    flight::PerPhase<std::optional<PhaseContribution>> phases;
};

/// Errors of one model on hold-out flights.
struct HeldOutScore {
    std::string model;  ///< as leave_one_out calls it, or as default_model
    std::size_t flights = 0;
    double mean_absolute_error_percent = 0.0;  ///< of the flights' energy
};

/// Cross-validation of the models of a file (validation_of).
struct ModelValidation {
    std::string default_model;         ///< of missions that state no airspeed (default_model)
    std::vector<HeldOutScore> scores;  ///< without rejected models
};

/// Power over a whole flight (Eqs. 2-4), with the flights it was made from.
struct MechanicalModel {
    std::string name;
    std::string description;  ///< how it was made, for people
    std::string weighting;    ///< "uniform", "agreement", "by hand" or "published"; older files also "inverse-variance"
    flight::PerPhase<PhaseModel> phases;
    std::vector<FlightContribution> flights;
    std::optional<PhysicalModel> physical = {};      ///< power by motion; absent unless fitted
    std::optional<ModelValidation> validation = {};  ///< absent in files of fit, and of earlier versions
    bool is_rotorcraft = false;                      ///< all of its flights are; not known of files of fourier curves
    std::optional<double> pack_voltage_v = {};       ///< highest of the flights' packs; absent if none was measured
};

/// The name of what predicts all phases: "fourier", "constant_mean", or "by_phase" where they differ.
std::string default_model(const MechanicalModel& model);

/// Whether a model has a physical part that predicted flights left out no worse than their mean power. Without a
/// validation, one of several flights was asked for, and counts.
bool motion_predicts_best(const MechanicalModel& model);

/// The model with the power that predicts: a constant, the mean of equally weighted flights, in the phases whose
/// decision is the mean.
MechanicalModel with_decided_power(MechanicalModel model);

/// The time scale of a phase with another duration than the model's.
enum class PhaseTimeScaling {
    scaled,   ///< the curve is scaled to the phase's duration
    absolute  ///< the curve continues in the model's own seconds
};

/// The curve of `phase` when the phase takes `flown_s` seconds.
FourierModel time_scaled_model(const PhaseModel& phase, double flown_s, PhaseTimeScaling clock);

/// fits/mechanical/NAME.toml (docs/formats.md). Reading throws InputError with its location for a missing, unknown or
/// invalid key.
MechanicalModel read_mechanical_model(const std::filesystem::path& path);
/// The same with_decided_power. Throws InputError also for a curve whose mean is beyond twice the greatest mean power of
/// its flights, or below 0 where theirs is not: the samples did not determine it.
MechanicalModel read_predicting_model(const std::filesystem::path& path);
std::string to_toml(const MechanicalModel& model);

/// Number of evenly spread points that resolve the series over `duration_s`: 16 a period of its highest harmonic, and
/// at least 1000.
std::size_t curve_point_count(const FourierModel& model, double duration_s);

/// f [W] at the middles of `points` equal parts of the phase.
std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points);

/// The root mean square of the difference between two phases' curves [W], each over its own duration: the
/// curves are compared at equal parts of the phase, whatever the seconds.
double rms_difference_w(const PhaseModel& a, const PhaseModel& b);

/// Warnings for users, a line each: a phase that is predicted by a curve that falls below 0 W.
std::vector<std::string> model_warnings(const MechanicalModel& model);

/// Remarks on the fit, a line each: what predicts a phase and why, samples excluded, a frequency at a bound or not
/// determined, reduced harmonics.
std::vector<std::string> fit_notes(const MechanicalModel& model);

/// Returns the most harmonics that a phase of the model has.
std::size_t model_order(const MechanicalModel& model);

/// Returns what the cruise of the model's flights takes beyond level flight straight ahead at their airspeeds, by turns,
/// climbs and gusts [W], at least 0; 0 if no airspeed is known.
double power_beyond_straight_flight_w(const MechanicalModel& model);

}  // namespace flightwatt::mechanical
