#pragma once

#include "flight/flight_phases.h"
#include "mechanical/level_law.h"
#include "mechanical/uncertainty/phase_uncertainty.h"

#include <cstddef>
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

/// "none", "low", "high".
std::string_view to_string(FrequencyBound bound);

/// Where the frequency of a fit was allowed to be, as omega * duration [rad].
struct FrequencyRange {
    double low_rad = 0.0;   ///< below, the basis becomes collinear
    double high_rad = 0.0;  ///< above, the third harmonic is faster than the samples
    FrequencyBound at_bound = FrequencyBound::none;
};

/// How the flights of one phase differ from the model and change meanwhile: what a prediction's interval
/// needs.
struct LevelSpread {
    std::size_t flights = 0;     ///< 2 or more: what the standard deviation between them rests on
    double level_sd_w = 0.0;     ///< of the flights' mean powers
    double drift_sd_w = 0.0;     ///< of the power about the curve at the flight's own level
    double correlation_s = 0.0;  ///< for how long that deviation lasts (exponential correlation)
};

/// One phase of the model: the flights' weighted average (Eqs. 5-7) and what it rests on.
struct PhaseModel {
    FourierModel fourier;
    double duration_s = 0.0;      ///< weighted average duration
    std::optional<double> rms_w;  ///< residual of the flights' own curves; absent if published without
    std::optional<FrequencyRange> range;
    std::size_t samples = 0;
    std::size_t flights = 0;
    std::optional<PhaseErrors> errors = {};  ///< absent unless they were asked for
    std::optional<PhaseSpread> spread = {};  ///< absent too where a single flight counts
    /// Absent with fewer than 2 flights, or if published without.
    std::optional<LevelSpread> level_spread = {};
    std::optional<LevelLaw> level_law = {};  ///< absent unless it was asked for
    /// Of airspeed_cubed; absent unless 2 flights or more measured their airspeed.
    std::optional<LevelLaw> airspeed_law = {};
};

/// One flight's part in one phase.
struct PhaseContribution {
    double weight = 0.0;  ///< in [0, 1]; the flights' weights of a phase sum to 1
    double duration_s = 0.0;
    double rms_w = 0.0;
    std::size_t samples = 0;
};

struct FlightContribution {
    std::string flight;
    flight::PerPhase<std::optional<PhaseContribution>> phases;
};

/// Power over a whole flight (Eqs. 2-4), with the flights it was made from.
struct MechanicalModel {
    std::string name;
    std::string description;  ///< how it was made, for people
    std::string weighting;    ///< "uniform", "inverse-variance", "agreement", "by hand" or "published"
    flight::PerPhase<PhaseModel> phases;
    std::vector<FlightContribution> flights;
};

/// How a phase flown in another time than the model's is read.
enum class PhaseClock {
    stretched,  ///< the curve is stretched or squeezed to the time flown
    absolute    ///< the curve runs on in the model's own seconds
};

/// The curve of `phase` when the phase takes `flown_s` seconds.
FourierModel flown_model(const PhaseModel& phase, double flown_s, PhaseClock clock);

/// fits/mechanical/NAME.toml. Reading throws InputError with its place for a missing or unknown key, other
/// numbers of cosines than sines, a duration or frequency that is not positive, a count that is not whole, a
/// weight outside [0, 1], or errors and spreads that cannot be (see phase_uncertainty_toml.h).
MechanicalModel read_mechanical_model(const std::filesystem::path& path);
std::string to_toml(const MechanicalModel& model);

}  // namespace flightwatt::mechanical
