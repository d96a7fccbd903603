#include "mechanical/mechanical_model.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

bool counts(const std::optional<PhaseContribution>& part) { return part && part->weight > 0.0 && part->mean_power_w; }

void use_mean_power(MechanicalModel& model, flight::Phase phase) {
    std::vector<double> powers_w;
    for (const auto& flight : model.flights)
        if (const auto& part = flight.phases[phase]; counts(part)) powers_w.push_back(*part->mean_power_w);
    if (powers_w.empty()) return;
    for (auto& flight : model.flights)
        if (auto& part = flight.phases[phase])
            part->weight = counts(part) ? 1.0 / static_cast<double>(powers_w.size()) : 0.0;
    auto& mean_power = model.phases[phase];
    mean_power.fourier = {mean_power.fourier.omega_rad_per_s, mean(powers_w), {}, {}};
    mean_power.open_frequency = mean_power.not_negative = false;
    mean_power.errors.reset();  // the curve's
    mean_power.spread.reset();
}

/// The end of its range that the frequency has reached; empty: none.
std::string_view bound_reached(const PhaseModel& phase) {
    constexpr double tolerance = 1e-5;
    if (!phase.range || phase.fourier.cos_w.empty()) return "";
    const double theta_rad = phase.fourier.omega_rad_per_s * phase.duration_s;
    return theta_rad <= (1.0 + tolerance) * phase.range->low_rad    ? "low"
           : theta_rad >= (1.0 - tolerance) * phase.range->high_rad ? "high"
                                                                    : "";
}

}  // namespace

std::string default_model(const MechanicalModel& model) {
    const auto means = std::ranges::count_if(model.phases.values,
                                             [](const auto& phase) { return phase.power.by == PowerBasis::mean; });
    return means == 0 ? "fourier" : means == std::ssize(model.phases.values) ? "constant_mean" : "by_phase";
}

MechanicalModel with_decided_power(MechanicalModel model) {
    for (const auto phase : flight::all_phases)
        if (model.phases[phase].power.by == PowerBasis::mean) use_mean_power(model, phase);
    return model;
}

double power_w(const FourierModel& model, double time_s) {
    double power = model.a0_w;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        const double angle = static_cast<double>(n + 1) * model.omega_rad_per_s * time_s;
        power += model.cos_w[n] * std::cos(angle) + model.sin_w[n] * std::sin(angle);
    }
    return power;
}

double energy_j(const FourierModel& model, double time_s) {
    double energy = model.a0_w * time_s;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        const double omega = static_cast<double>(n + 1) * model.omega_rad_per_s;
        // 1 - cos(x) = 2 sin^2(x/2), without cancellation
        const double half = std::sin(omega * time_s / 2.0);
        energy += (model.cos_w[n] * std::sin(omega * time_s) + model.sin_w[n] * 2.0 * half * half) / omega;
    }
    return energy;
}

FourierModel time_scaled_model(const PhaseModel& phase, double flown_s, PhaseTimeScaling clock) {
    FourierModel flown = phase.fourier;
    if (clock == PhaseTimeScaling::scaled) flown.omega_rad_per_s *= phase.duration_s / flown_s;
    return flown;
}

Interval student_t_interval(double value, double standard_error, double degrees_of_freedom) {
    const double half = student_t_half_width(degrees_of_freedom) * standard_error;
    return {value - half, value + half};
}

CoefficientIntervals coefficient_intervals(const PhaseModel& phase) {
    const auto& errors = phase.errors.value();
    const auto about = [&](double value, double error) {
        return student_t_interval(value, error, errors.degrees_of_freedom);
    };
    CoefficientIntervals intervals{
        about(phase.fourier.omega_rad_per_s, errors.omega_rad_per_s), about(phase.fourier.a0_w, errors.a0_w), {}, {}};
    if (phase.range) {
        auto& [low, high] = intervals.omega_rad_per_s;
        low = std::max(low, std::min(phase.range->low_rad / phase.duration_s, phase.fourier.omega_rad_per_s));
        high = std::min(high, std::max(phase.range->high_rad / phase.duration_s, phase.fourier.omega_rad_per_s));
    }
    for (std::size_t n = 0; n < phase.fourier.cos_w.size(); ++n) {
        intervals.cos_w.push_back(about(phase.fourier.cos_w[n], errors.cos_w[n]));
        intervals.sin_w.push_back(about(phase.fourier.sin_w[n], errors.sin_w[n]));
    }
    return intervals;
}

std::size_t curve_point_count(const FourierModel& model, double duration_s) {
    const double turns = model.omega_rad_per_s * duration_s / units::rad_per_turn;
    const double swings = turns * static_cast<double>(model.cos_w.size());
    return std::max<std::size_t>(1000, static_cast<std::size_t>(std::ceil(16.0 * swings)));
}

std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points) {
    std::vector<double> curve(points);
    for (std::size_t i = 0; i < points; ++i) {
        const double tau = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
        curve[i] = power_w(model, tau * duration_s);
    }
    return curve;
}

double rms_difference_w(const PhaseModel& a, const PhaseModel& b) {
    const auto points =
        std::max(curve_point_count(a.fourier, a.duration_s), curve_point_count(b.fourier, b.duration_s));
    const auto curve_a = curve_w(a.fourier, a.duration_s, points);
    const auto curve_b = curve_w(b.fourier, b.duration_s, points);
    double sum = 0.0;
    for (std::size_t i = 0; i < points; ++i) sum += std::pow(curve_a[i] - curve_b[i], 2);
    return std::sqrt(sum / static_cast<double>(points));
}

std::vector<std::string> model_warnings(const MechanicalModel& model) {
    std::vector<std::string> warnings;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        if (fitted.power.by == PowerBasis::mean) continue;
        const auto curve =
            curve_w(fitted.fourier, fitted.duration_s, curve_point_count(fitted.fourier, fitted.duration_s));
        if (const double lowest_w = *std::ranges::min_element(curve); lowest_w < 0.0)
            warnings.push_back(
                fmt::format("{}: the curve falls to {:.3g} W: implausible without regeneration; try "
                            "another order or more flights",
                            to_string(phase), lowest_w));
    }
    return warnings;
}

std::vector<std::string> fit_notes(const MechanicalModel& model) {
    std::vector<std::string> notes;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        const auto note = [&](const std::string& text) {
            notes.push_back(fmt::format("{}: {}", to_string(phase), text));
        };
        if (fitted.power.by == PowerBasis::mean)
            note(fmt::format("predicted by its mean power: {}", fitted.power.reason));
        if (fitted.edge_samples > 0)
            note(fmt::format("{} sample{} left out at its ends: the power is that of the neighbouring phase",
                             fitted.edge_samples, fitted.edge_samples == 1 ? " was" : "s were"));
        if (const auto bound = bound_reached(fitted); !bound.empty())
            note(fmt::format("the frequency is at its {} bound: the data determine the curve, but not its frequency",
                             bound));
        if (fitted.open_frequency)
            note("the samples do not determine the frequency: the coefficients describe this curve only");
        if (fitted.not_negative) note("the curve would fall below 0 W: its harmonics were reduced");
    }
    return notes;
}

}  // namespace flightwatt::mechanical
