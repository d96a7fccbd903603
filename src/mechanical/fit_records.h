#pragma once

#include "flight/flight_phases.h"
#include "mechanical/mechanical_model.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Options and results of a fit.
namespace flightwatt::mechanical {

struct MeanCurve;
struct PhaseSamples;

/// The highest order that is supported; beyond it the lowest admissible frequencies leave no digits.
inline constexpr int max_order = 8;

constexpr int coefficient_count(int order) { return 2 * order + 1; }

struct PhaseFitOptions {
    int order = 3;  ///< of the Fourier series, 0 (a constant) to max_order
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
    double autocorrelation = 0.0;     ///< of neighbouring residuals, 0 to max_autocorrelation
    double degrees_of_freedom = 1.0;  ///< number of independent residuals less coefficients; 1 or more
    /// Frequencies (theta) more than a step of the scan away that fit almost as well (95 %), at most 100: with any of
    /// them the frequency is not determined, and the coefficients describe this curve only.
    std::vector<double> rivals_rad = {};
    bool is_clamped = false;  ///< harmonics were reduced (hold_above_zero)
};

/// Minimum number of samples of a flight: one more than its coefficients; one for a mean (order 0).
constexpr std::size_t min_samples(int order) {
    return order == 0 ? 1 : static_cast<std::size_t>(coefficient_count(order)) + 1;
}

/// The range of theta: from pi to 120 periods, and below the frequency at which, in some flight, the highest harmonic
/// has less than two samples a period (of the median gap), or little more. Throws UsageError for an invalid order, NoResultError for an empty range.
FrequencyRange admissible_frequencies(std::span<const PhaseSamples> flights, const PhaseFitOptions& options);

/// The weight of a flight in the average of its phase (the w_i of Eqs. 5-7).
enum class Weighting {
    uniform,   ///< equal
    agreement  ///< flights whose curve is near the others' count more
};

/// In the order of Weighting.
inline constexpr std::array<std::string_view, 2> weighting_names{"uniform", "agreement"};

constexpr std::string_view to_string(Weighting weighting) {
    return weighting_names[static_cast<std::size_t>(weighting)];
}

constexpr std::optional<Weighting> weighting_from(std::string_view name) {
    for (std::size_t i = 0; i < weighting_names.size(); ++i)
        if (name == weighting_names[i]) return static_cast<Weighting>(i);
    return std::nullopt;
}

/// The uncertainty of a phase's weighted mean curve that comes from the noise of the samples.
struct ErrorAnalysis {
    PhaseErrors errors;
    std::shared_ptr<const MeanCurve> curve;
};

}  // namespace flightwatt::mechanical
