#include "mechanical/model_check.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

void warn_of_negative_power(std::string_view phase, const PhaseModel& fitted, std::vector<std::string>& warnings) {
    const auto points = curve_point_count(fitted.fourier, fitted.duration_s);
    const double step_s = fitted.duration_s / static_cast<double>(points);
    double min_w = power_w(fitted.fourier, 0.0);
    double min_at_s = 0.0;
    std::size_t below = 0;
    for (std::size_t i = 0; i <= points; ++i) {
        const double time_s = static_cast<double>(i) * step_s;
        const double power = power_w(fitted.fourier, time_s);
        if (power < 0.0) ++below;
        if (power >= min_w) continue;
        min_w = power;
        min_at_s = time_s;
    }
    if (below == 0) return;
    warnings.push_back(fmt::format(
        "{}: the curve falls to {:.3g} W ({:.1f} s after the phase began), below 0 for {:.1f} of {:.1f} s, "
        "and no drone takes energy back: another order or more flights may mend it",
        phase, min_w, min_at_s, std::min(static_cast<double>(below) * step_s, fitted.duration_s), fitted.duration_s));
}

}  // namespace

std::vector<std::string> model_warnings(const MechanicalModel& model) {
    std::vector<std::string> warnings;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        warn_of_negative_power(to_string(phase), fitted, warnings);
        if (!fitted.errors || !fitted.errors->noise_lasts) continue;
        warnings.push_back(
            fmt::format("{}: the noise of neighbouring samples is as alike as can be told from the curve "
                        "(autocorrelation {:.2f}): the errors are no more than a bound",
                        to_string(phase), fitted.errors->autocorrelation));
    }
    return warnings;
}

std::vector<std::string> fit_notes(const MechanicalModel& model) {
    std::vector<std::string> notes;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        if (fitted.edge_samples > 0) {
            notes.push_back(
                fmt::format("{}: {} sample{} left out at its ends: the power is that of the neighbouring phase",
                            to_string(phase), fitted.edge_samples, fitted.edge_samples == 1 ? " was" : "s were"));
        }
        if (fitted.mean_curve) {
            notes.push_back(
                fmt::format("{}: the samples leave the frequency open: the curve is the mean over all that may be, and "
                            "its constants stand for that curve alone",
                            to_string(phase)));
        }
        if (fitted.not_negative) {
            notes.push_back(fmt::format(
                "{}: the curve would fall below 0 W, or below the negative power that was measured, and was "
                "held above",
                to_string(phase)));
        }
    }
    return notes;
}

}  // namespace flightwatt::mechanical
