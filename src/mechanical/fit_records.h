#pragma once

#include "flight/flight_phases.h"
#include "mechanical/mechanical_model.h"

#include <array>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What is asked of a fit, and what it finds.
namespace flightwatt::mechanical {

struct MeanCurve;
struct PhaseSamples;

/// The highest order that is supported; beyond it the lowest admissible frequencies leave no digits.
inline constexpr int max_order = 8;

constexpr int coefficient_count(int order) { return 2 * order + 1; }

/// How a residual far from the curve counts.
enum class Loss {
    none,  ///< squared
    huber  ///< squared to 1.345 scales, beyond that as its size
};

constexpr std::string_view to_string(Loss loss) { return loss == Loss::huber ? "huber" : "none"; }

constexpr std::optional<Loss> loss_from(std::string_view name) {
    for (const auto loss : {Loss::none, Loss::huber})
        if (name == to_string(loss)) return loss;
    return std::nullopt;
}

struct PhaseFitOptions {
    int order = 3;  ///< of the Fourier series, 0 (a constant) to max_order
    /// Lowest omega * duration. The fewer periods a phase has, the more alike its harmonics are, and noise in
    /// the coefficients grows: at order 3 the basis's condition is 1 at 2 pi, 38 at the paper's landing (3.63),
    /// 108 at pi, but 2500 at 2 rad and 230000 at 1 rad.
    double min_theta_rad = std::numbers::pi;
    /// Most periods in a phase; the sampling may allow fewer. 120 in ten minutes are 5 s each: nothing that
    /// an aircraft does over and over in cruise is faster.
    double max_periods = 120.0;
    Loss loss = Loss::none;  ///< huber: outliers count less in the last refinement
};

/// One flight's own curve in one phase, in that flight's own seconds.
struct FlightCurve {
    std::string flight;
    double duration_s = 0.0;
    FourierModel fourier;  ///< omega_rad_per_s = theta / duration_s
    double rms_w = 0.0;    ///< of the residuals
    std::size_t samples = 0;
};

/// All flights of one phase, fitted with one frequency in their own normalised time (Eq. 1).
struct PhaseFit {
    double theta_rad = 0.0;  ///< omega * duration, common to all
    FrequencyRange range;
    std::vector<FlightCurve> flights;  ///< in the order of the samples
    double rms_w = 0.0;                ///< of all flights' residuals together
    std::size_t samples = 0;
    Loss loss = Loss::none;
    double loss_scale_w = 0.0;       ///< of the noise as the loss saw it; 0 without a loss
    bool is_frequency_open = false;  ///< other frequencies are almost as good: constants stand for this curve alone
    bool is_clamped = false;  ///< curves were kept from falling below 0, or below negative power that was measured
};

/// So many samples a flight needs at least: one more than its coefficients.
constexpr std::size_t min_samples(int order) { return static_cast<std::size_t>(coefficient_count(order)) + 1; }

/// Where theta may lie: from options.low_rad to options.max_periods periods, but not so high that in some
/// flight the highest harmonic would have less than two samples a period (of the median gap between samples), or that
/// its two columns are so alike on the samples that noise in one direction of them is more than twice (its variance)
/// what it is on well spread ones: as near to two samples a period as evenly spread ones would allow.
/// Throws UsageError for options that make no sense, NoResultError if the samples leave nothing of the range.
FrequencyRange admissible_frequencies(std::span<const PhaseSamples> flights, const PhaseFitOptions& options);

/// How much a flight counts in the average of its phase (the w_i of Eqs. 5-7).
enum class Weighting {
    uniform,           ///< every flight the same
    inverse_variance,  ///< samples / rms^2: flights that scatter little about their curve count more
    agreement,         ///< flights whose curve resembles the others' count more
    manual
};

/// In the order of Weighting.
inline constexpr std::array<std::string_view, 4> weighting_names{"uniform", "inverse-variance", "agreement", "by hand"};

constexpr std::string_view to_string(Weighting weighting) {
    return weighting_names[static_cast<std::size_t>(weighting)];
}

constexpr std::optional<Weighting> weighting_from(std::string_view name) {
    for (std::size_t i = 0; i < weighting_names.size(); ++i)
        if (name == weighting_names[i]) return static_cast<Weighting>(i);
    return std::nullopt;
}

/// A weight that the user chose, for one phase of a flight or, without a phase, for all its other phases.
struct ManualWeight {
    std::string flight;
    std::optional<flight::Phase> phase;
    double weight = 0.0;  ///< 0 or more, in any scale
};

struct WeightOptions {
    Weighting weighting = Weighting::agreement;
    std::vector<ManualWeight> by_hand;  ///< for Weighting::by_hand only, and then for every flight
};

/// The uncertainty of a phase's weighted mean curve that comes from the noise of the samples.
struct ErrorAnalysis {
    PhaseErrors errors;
    double theta_rad = 0.0;
    std::shared_ptr<const MeanCurve> curve;
};

/// How the flights' common residual grows as the frequency leaves its best value, all coefficients following.
struct FrequencyProfile {
    std::vector<double> theta_rad;  ///< omega * duration, rising
    std::vector<double> rms_w;      ///< of all residuals at each
    double low_rad = 0.0;           ///< the 95 % interval of theta
    double high_rad = 0.0;
    bool low_is_open = false;  ///< the interval ends where the admissible range does, not where the data say so
    bool high_is_open = false;
};

}  // namespace flightwatt::mechanical
