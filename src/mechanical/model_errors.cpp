#include "mechanical/model_errors.h"

#include "base/statistics.h"
#include "mechanical/flight_envelope.h"
#include "mechanical/phase_curve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

std::string phase_curve_csv(const ModelFit& fit, flight::Phase phase, const ErrorAnalysis& analysis) {
    const auto& model = fit.model.phases[phase];
    const auto points = points_of_curve(model.fourier, model.duration_s) / 5 + 1;
    const auto spread = flight_envelope(fit.fits[phase], fit.weights[phase], points);
    const double wide = student_t_half_width(analysis.errors.degrees_of_freedom);
    const double population_wide = spread ? student_t_half_width(spread->counted_flights - 1.0) : 0.0;
    std::string text;
    for (std::size_t i = 0; i < points; ++i) {
        const double tau = static_cast<double>(i) / static_cast<double>(points - 1);
        const double time_s = tau * model.duration_s;
        const double power = power_w(model.fourier, time_s);
        const double error = curve_standard_error_w(analysis, tau);
        text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", to_string(phase), tau, time_s,
                            power, error, power - wide * error, power + wide * error);
        if (!spread) {
            text += ",,,,,\n";
            continue;
        }
        const double reach = population_wide * population_standard_error_w(*spread, i);
        text += fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", spread->low_w[i], spread->high_w[i],
                            spread->standard_deviation_w[i], power - reach, power + reach);
    }
    return text;
}

}  // namespace

flight::PerPhase<ErrorAnalysis> analyse_model(ModelFit& fit) {
    flight::PerPhase<ErrorAnalysis> analyses;
    for (const auto phase : flight::all_phases) {
        analyses[phase] = analyse_errors(fit.samples[phase], fit.fits[phase], fit.weights[phase]);
        fit.model.phases[phase].errors = analyses[phase].errors;
        fit.model.phases[phase].spread = flight_envelope(fit.fits[phase], fit.weights[phase]);
    }
    return analyses;
}

flight::PerPhase<PhaseErrorReport> add_errors(ModelFit& fit) {
    auto analyses = analyse_model(fit);
    flight::PerPhase<PhaseErrorReport> reports;
    for (const auto phase : flight::all_phases) {
        reports[phase].profile = frequency_profile(fit.samples[phase], fit.fits[phase], analyses[phase]);
        reports[phase].analysis = std::move(analyses[phase]);
    }
    return reports;
}

flight::PerPhase<CurveBand> curve_bands(const ModelFit& fit,
                                        const flight::PerPhase<ErrorAnalysis>& analyses) {
    constexpr std::size_t points = 101;
    flight::PerPhase<CurveBand> bands;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = fit.model.phases[phase];
        const auto& analysis = analyses[phase];
        const double wide = student_t_half_width(analysis.errors.degrees_of_freedom);
        auto& band = bands[phase];
        for (std::size_t i = 0; i < points; ++i) {
            const double time_s =
                fitted.duration_s * static_cast<double>(i) / static_cast<double>(points - 1);
            const double power = power_w(fitted.fourier, time_s);
            const double reach = wide * curve_standard_error_w(analysis, time_s / fitted.duration_s);
            band.time_s.push_back(time_s);
            band.low_95_w.push_back(power - reach);
            band.high_95_w.push_back(power + reach);
        }
        const auto spread = flight_envelope(fit.fits[phase], fit.weights[phase], points);
        if (!spread) continue;
        band.flights_low_w = spread->low_w;
        band.flights_high_w = spread->high_w;
    }
    return bands;
}

std::string curves_csv(const ModelFit& fit, const flight::PerPhase<PhaseErrorReport>& reports) {
    std::string text =
        "phase,tau,time_s,power_w,standard_error_w,low_95_w,high_95_w,flights_low_w,flights_high_w,"
        "flights_sd_w,population_low_95_w,population_high_95_w\n";
    for (const auto phase : flight::all_phases) text += phase_curve_csv(fit, phase, reports[phase].analysis);
    return text;
}

}  // namespace flightwatt::mechanical
