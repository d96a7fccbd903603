#pragma once

#include "mechanical/fit/phase_fit.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mechanical {

/// How much a flight counts in the average of its phase (the w_i of Eqs. 5-7).
enum class Weighting {
    uniform,           ///< every flight the same
    inverse_variance,  ///< samples / rms^2: flights that scatter little about their curve count more
    agreement,         ///< flights whose curve resembles the others' count more
    manual
};

/// "uniform", "inverse-variance", "agreement", "by hand".
std::string_view to_string(Weighting weighting);
std::optional<Weighting> weighting_from(std::string_view name);

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

/// Throws UsageError for weights by hand that name no flight of `flights` (with the nearest name) or name one
/// twice for the same phase, are negative or not finite, or are given though the weighting is another.
void validate_weights(const WeightOptions& options, std::span<const std::string> flights);

/// The weights of the flights of one phase, in [0, 1], in their order; their sum is 1 (docs/methods.md, Eq. 9).
///   inverse-variance: an rms below a thousandth of the largest counts as that; all 0: by samples alone.
///   agreement: a stray flight counts little and none counts for all;
///     one flight has 1, two have 1/2 each, curves that are equal to rounding count the same.
///   by hand: normalised. Throws UsageError if a flight of the phase has none, or none is positive.
std::vector<double> flight_weights(const PhaseFit& fit, flight::Phase phase, const WeightOptions& options);

/// The weighted average of the flights' curves and durations (docs/methods.md, Eq. 8). The flights share
/// theta, so averaging curves at equal parts of the phase is averaging coefficients.
PhaseModel average_phase(const PhaseFit& fit, std::span<const double> weights);

}  // namespace flightwatt::mechanical
