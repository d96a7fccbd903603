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

/// Which end of its range a frequency stands at.
enum class FrequencyBound { none, low, high };
std::string_view to_string(FrequencyBound bound);

/// Where the frequency of a fit was allowed to be, as omega * duration [rad].
struct FrequencyRange {
    double low_rad = 0.0;   ///< below, the basis becomes collinear
    double high_rad = 0.0;  ///< above, the third harmonic is faster than the samples
    FrequencyBound at_bound = FrequencyBound::none;
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

/// How well the noise of the samples lets a phase's averaged coefficients be known, about: standard errors of the weighted
/// mean of these very flights, weights and durations taken as given, at all frequencies that fit (analyse_errors). How
/// flights differ is another question: see FlightEnvelope.
struct PhaseErrors {
    double omega_rad_per_s = 0.0;
    double a0_w = 0.0;
    std::vector<double> cos_w;
    std::vector<double> sin_w;
    double curve_w = 0.0;             ///< root mean square over the phase of the curve's own standard error
    double degrees_of_freedom = 0.0;  ///< of their Student's t
    /// The errors hold for the frequency as given: the curve is a constant, or (of files of 0.2) it stands at a bound.
    bool frequency_is_fixed = false;
    double r2 = 0.0;                 ///< of all samples about their own flights' curves and means
    double condition = 0.0;          ///< of the basis on the samples, columns of length 1; the worst flight's
    double autocorrelation = 0.0;    ///< of neighbouring residuals
    double effective_samples = 0.0;  ///< independent samples that would tell the mean as well
};

/// How the flights' own curves differ over the phase, at evenly spread parts of it from begin to end.
struct FlightEnvelope {
    std::vector<double> low_w;                 ///< the least of the flights that count (the paper's grey band)
    std::vector<double> high_w;                ///< the greatest of them
    std::vector<double> standard_deviation_w;  ///< of one flight about the weighted mean
    double effective_flights = 0.0;            ///< 1 / sum of squared weights: equal flights worth as much
};

/// How the flights of one phase differ from the model and change meanwhile: what a prediction's interval needs.
struct VarianceComponents {
    std::size_t flights = 0;           ///< 2 or more: what the standard deviation between them rests on
    double between_flight_sd_w = 0.0;  ///< of the flights' mean powers
    double drift_sd_w = 0.0;           ///< of the power about the curve at the flight's own level
    double correlation_s = 0.0;        ///< for how long that deviation lasts (exponential correlation)
};

/// A phase's power as one constant.
struct ConstantPower {
    double mean_w = 0.0;
    std::optional<double> sd_w;  ///< of a flight's mean power about it, its own error included
    double degrees_of_freedom = 0.0;
};

struct PhaseModel;

/// The coefficients' intervals by Student's t, that of the frequency within its range. The phase must have errors.
CoefficientIntervals coefficient_intervals(const PhaseModel& phase);

/// One phase of the model: the flights' weighted average (Eqs. 5-7) and what it rests on.
struct PhaseModel {
    FourierModel fourier;
    double duration_s = 0.0;      ///< weighted average duration
    std::optional<double> rms_w;  ///< residual of the flights' own curves; absent if published without
    std::optional<FrequencyRange> range;
    std::size_t samples = 0;
    std::size_t flights = 0;
    std::size_t edge_samples = 0;  ///< left out at the phase's ends: their power is the neighbouring phase's
    bool open_frequency = false;   ///< other frequencies fit almost as well: the constants stand for this curve alone
    bool not_negative = false;     ///< the curve was kept from falling below 0, or below negative power measured
    std::optional<PhaseErrors> errors = {};     ///< absent unless they were asked for
    std::optional<FlightEnvelope> spread = {};  ///< absent too where a single flight counts
    /// Absent with fewer than 2 flights, or if published without.
    std::optional<VarianceComponents> level_spread = {};
};

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

/// How one model predicted flights that were left out of the fit.
struct HeldOutScore {
    std::string model;  ///< as leave_one_out calls it
    std::size_t flights = 0;
    double mean_absolute_error_percent = 0.0;  ///< of the flights' energy
};

/// How the models of a file predict flights (validation_of).
struct ModelValidation {
    bool prefers_curve = false;        ///< to the mean power of each phase, where nothing states an airspeed
    std::vector<HeldOutScore> scores;  ///< without rejected models
};

/// The model that missions use where they state no airspeed, as leave_one_out calls it.
std::string_view default_model(const ModelValidation& validation);

/// Power over a whole flight (Eqs. 2-4), with the flights it was made from.
struct MechanicalModel {
    std::string name;
    std::string description;  ///< how it was made, for people
    std::string weighting;    ///< "uniform", "inverse-variance", "agreement", "by hand" or "published"
    flight::PerPhase<PhaseModel> phases;
    std::vector<FlightContribution> flights;
    std::optional<PhysicalModel> physical = {};      ///< power of the motion, beside that of time; absent unless fitted
    std::optional<ModelValidation> validation = {};  ///< absent in files of fit, and of earlier versions
};

/// The model with the power that missions use: each phase's mean power, every flight counting the same, if its
/// validation does not prefer the curve.
MechanicalModel with_default_power(MechanicalModel model);

/// How a phase flown in another time than the model's is read.
enum class PhaseTimeScaling {
    stretched,  ///< the curve is stretched or squeezed to the time flown
    absolute    ///< the curve runs on in the model's own seconds
};

/// The curve of `phase` when the phase takes `flown_s` seconds.
FourierModel time_scaled_model(const PhaseModel& phase, double flown_s, PhaseTimeScaling clock);

/// fits/mechanical/NAME.toml. Reading throws InputError with its place for a missing or unknown key, other
/// numbers of cosines than sines, a duration or frequency that is not positive, a count that is not whole, a
/// weight outside [0, 1], or errors and spreads that cannot be.
MechanicalModel read_mechanical_model(const std::filesystem::path& path);
std::string to_toml(const MechanicalModel& model);

/// How many evenly spread points show every swing of the series over `duration_s`: 16 a period of its highest
/// harmonic, and at least 1000.
std::size_t curve_point_count(const FourierModel& model, double duration_s);

/// f [W] at the middles of `points` equal parts of the phase.
std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points);

/// The root mean square of the difference between two phases' curves [W], each over its own duration: the
/// curves are compared at equal parts of the phase, whatever the seconds.
double rms_difference_w(const PhaseModel& a, const PhaseModel& b);

/// What a user should know of a model before it is used, a line each: a phase whose curve falls below 0 W, where a
/// drone takes no energy back.
std::vector<std::string> model_warnings(const MechanicalModel& model);

/// How the fit came to its curves where that is not least squares of all samples, a line each: samples that were left
/// out, a frequency that these leave open, a curve that was held above 0 W.
std::vector<std::string> fit_notes(const MechanicalModel& model);

}  // namespace flightwatt::mechanical
