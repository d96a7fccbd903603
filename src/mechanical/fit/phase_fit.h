#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// Fits Fourier series to all flights: scans the whole range of theta, refines the lowest minima, and solves for the
/// coefficients. Curves do not fall below 0 (hold_above_zero). Order 0 is each flight's own mean. Throws NoResultError
/// naming flight and phase for a flight with fewer than min_samples(order) samples or samples that do not determine the
/// series, and for no flights.
PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options = {});

/// Changes the harmonics of curves that fall below 0, at the same mean power, so that they do not. Sets
/// PhaseFit::is_clamped.
void hold_above_zero(std::span<const PhaseSamples> flights, PhaseFit& fit);

/// The weights of the flights of one phase, in [0, 1], in their order; their sum is 1 (docs/methods.md, Eq. 9). By
/// agreement outliers count little; one flight has 1, two have 1/2 each, equal curves have equal weights.
std::vector<double> flight_weights(const PhaseFit& fit, Weighting weighting);

/// The weighted average of the flights' coefficients and durations (docs/methods.md, Eq. 8), which have one theta.
PhaseModel average_phase(const PhaseFit& fit, std::span<const double> weights);

/// Variability of `flights` about the model's phase; std::nullopt for fewer than 2. Between flights: sample standard
/// deviation of their mean powers. Drift: the residuals of the model's curve at each flight's own level, in blocks of
/// 30 s (a tenth of the shortest phase, if that is less): their variance and the correlation of neighbours, corrected
/// for the subtracted level; the correlation lasts no longer than a phase. Where the phases' halves differ by more than
/// such a drift explains, their difference determines its size.
std::optional<VarianceComponents> estimate_variance_components(const PhaseModel& model,
                                                               std::span<const PhaseSamples> flights);

/// The mean of the flights' mean powers, s^2 (1 + 1/n). `flights` must not be empty.
ConstantPower constant_mean(std::span<const PhaseSamples> flights);

/// Errors of the flights' mean curve from the noise of their samples (docs/methods.md, Errors of the fit): least
/// squares at the frequency found, at frequencies around it and at its rivals, as far as the samples admit them.
/// `flights`, `fit` and `weights` are in the same order; their samples are those that were fitted.
ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights);

/// The standard error [W] of the mean curve at tau in [0, 1] of the phase; its Student's t has
/// errors.degrees_of_freedom.
double curve_standard_error_w(const ErrorAnalysis& analysis, double tau);

}  // namespace flightwatt::mechanical
