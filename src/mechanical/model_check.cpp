#include "mechanical/model_check.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

void warn_of_negative_power(std::string_view phase, const PhaseModel& fitted, std::vector<std::string>& warnings) {
    const auto points = points_of_curve(fitted.fourier, fitted.duration_s);
    const double step_s = fitted.duration_s / static_cast<double>(points);
    double least_w = power_w(fitted.fourier, 0.0);
    double least_at_s = 0.0;
    std::size_t below = 0;
    for (std::size_t i = 0; i <= points; ++i) {
        const double time_s = static_cast<double>(i) * step_s;
        const double power = power_w(fitted.fourier, time_s);
        if (power < 0.0) ++below;
        if (power >= least_w) continue;
        least_w = power;
        least_at_s = time_s;
    }
    if (below == 0) return;
    warnings.push_back(
        fmt::format("{}: the curve falls to {:.3g} W ({:.1f} s after the phase began), below 0 for {:.1f} of {:.1f} s, "
                    "and no drone takes energy back: another order or more flights may mend it",
                    phase, least_w, least_at_s, std::min(static_cast<double>(below) * step_s, fitted.duration_s),
                    fitted.duration_s));
}

}  // namespace

std::vector<std::string> model_warnings(const MechanicalModel& model) {
    std::vector<std::string> warnings;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        warn_of_negative_power(to_string(phase), fitted, warnings);
        if (!fitted.errors || fitted.errors->autocorrelation < highest_autocorrelation) continue;
        warnings.push_back(
            fmt::format("{}: the noise of neighbouring samples is as alike as can be told (autocorrelation {}): {}",
                        to_string(phase), highest_autocorrelation,
                        fitted.errors->from_flights ? "the errors are taken from the differences between the flights"
                                                    : "the errors are no more than a bound"));
    }
    return warnings;
}

}  // namespace flightwatt::mechanical
