#include "mechanical/prediction.h"

#include "base/error.h"
#include "base/units.h"
#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flightwatt::mechanical {
namespace {

/// Variances [W^2] of the mean powers of the flown and the remaining cruise about their expectation.
struct CruiseVariances {
    double level_w2 = 0.0;
    double flown_drift_w2 = 0.0;
    double remaining_drift_w2 = 0.0;
    double drift_covariance_w2 = 0.0;
    double flown_w2() const { return level_w2 + flown_drift_w2; }
};

/// Variance of the gain times the flown mean, to first order: the estimates of level and drift have relative variances
/// 2 / degrees of freedom, and the gain changes oppositely with the logarithms of both.
double gain_variance_w2(const CruiseVariances& of, double degrees_of_freedom) {
    if (!(of.flown_w2() > 0.0)) return 0.0;
    const double change_w = of.level_w2 * (of.flown_drift_w2 - of.drift_covariance_w2) / of.flown_w2();
    return change_w * change_w / of.flown_w2() * 4.0 / degrees_of_freedom;
}

/// Half width of the 95 % interval of a phase's mean power, where it is known.
std::optional<double> mean_power_half_width_w(const WeightedPhase& phase, std::size_t flights) {
    const auto& model = phase.model;
    if (flights > 1 && model.level_spread)
        return student_t_half_width(static_cast<double>(model.level_spread->flights - 1)) *
               model.level_spread->between_flight_sd_w * std::sqrt(phase.weight_square_sum);
    if (flights != 1 || !model.errors || !model.rms_w || !(model.errors->effective_samples > 0.0)) return std::nullopt;
    return student_t_half_width(model.errors->degrees_of_freedom) * *model.rms_w /
           std::sqrt(model.errors->effective_samples);
}

}  // namespace

void add_variance(EnergyEstimate& estimate, double variance_wh2, double degrees_of_freedom) {
    estimate.variance_wh2 += variance_wh2;
    if (variance_wh2 > 0.0) estimate.satterthwaite_sum += variance_wh2 * variance_wh2 / degrees_of_freedom;
}

EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b) {
    return {a.energy_wh + b.energy_wh, a.uncertainty_known && b.uncertainty_known, a.variance_wh2 + b.variance_wh2,
            a.satterthwaite_sum + b.satterthwaite_sum};
}

std::optional<EnergyInterval> interval_95(const EnergyEstimate& estimate) {
    if (!estimate.uncertainty_known) return std::nullopt;
    double half_wh = 0.0;
    if (estimate.variance_wh2 > 0.0) {
        const double degrees_of_freedom = estimate.variance_wh2 * estimate.variance_wh2 / estimate.satterthwaite_sum;
        half_wh = student_t_half_width(degrees_of_freedom) * std::sqrt(estimate.variance_wh2);
    }
    return EnergyInterval{std::max(estimate.energy_wh - half_wh, std::min(estimate.energy_wh, 0.0)),
                          estimate.energy_wh + half_wh};
}

WeightedPhase forecast_of(const MechanicalModel& model, flight::Phase phase) {
    WeightedPhase forecast{model.phases[phase], 0.0};
    for (const auto& flight : model.flights) {
        if (const auto& part = flight.phases[phase]) forecast.weight_square_sum += std::pow(part->weight, 2);
    }
    if (forecast.weight_square_sum == 0.0) {
        forecast.weight_square_sum = 1.0 / static_cast<double>(std::max<std::size_t>(forecast.model.flights, 1));
    }
    return forecast;
}

std::optional<MeanPower> mean_power(const MechanicalModel& model, flight::Phase phase) {
    MeanPower power;
    for (const auto& flight : model.flights) {
        const auto& part = flight.phases[phase];
        if (!part || !(part->weight > 0.0)) continue;
        if (!part->mean_power_w) return std::nullopt;
        power.mean_w += part->weight * *part->mean_power_w;
        ++power.flights;
    }
    if (power.flights == 0) return std::nullopt;
    const auto forecast = forecast_of(model, phase);
    power.samples = forecast.model.samples;
    if (const auto half_w = mean_power_half_width_w(forecast, power.flights))
        power.interval = {std::max(power.mean_w - *half_w, std::min(power.mean_w, 0.0)), power.mean_w + *half_w};
    return power;
}

EnergyEstimate predict_before_flight(const WeightedPhase& phase, double duration_s) {
    return predict_remaining_before_flight(phase, 0.0, duration_s);
}

EnergyEstimate energy_of(const ConstantPower& power, double duration_s) {
    EnergyEstimate estimate{units::wh_from_joule(power.mean_w * duration_s), power.sd_w.has_value(), 0.0, 0.0};
    if (power.sd_w)
        add_variance(estimate, std::pow(units::wh_from_joule(*power.sd_w * duration_s), 2), power.degrees_of_freedom);
    return estimate;
}

EnergyEstimate predict_remaining_before_flight(const WeightedPhase& phase, double flown_s, double remaining_s) {
    const double duration_s = flown_s + remaining_s;
    const auto curve = time_scaled_model(phase.model, duration_s, PhaseTimeScaling::scaled);
    const double rest_j = energy_j(curve, duration_s) - energy_j(curve, flown_s);
    EnergyEstimate estimate{units::wh_from_joule(rest_j), phase.model.level_spread.has_value(), 0.0, 0.0};
    if (!phase.model.level_spread) return estimate;
    const auto& spread = *phase.model.level_spread;
    const double sd_wh = units::wh_from_joule(spread.between_flight_sd_w * remaining_s);
    add_variance(estimate, sd_wh * sd_wh * (1.0 + phase.weight_square_sum), static_cast<double>(spread.flights - 1));
    return estimate;
}

RemainingCruise predict_remaining_cruise(const WeightedPhase& cruise, const FlightProgress& flown, double remaining_s,
                                         CruisePrior prior) {
    if (!cruise.model.level_spread)
        throw NoResultError("the model has no variability between flights: fit two flights or more");
    RemainingCruise rest;
    if (remaining_s == 0.0) return rest;
    const double flown_s = flown.cruise_s();
    const double duration_s = flown_s + remaining_s;
    const auto curve = time_scaled_model(cruise.model, duration_s, PhaseTimeScaling::scaled);
    const double flown_j = energy_j(curve, flown_s);
    const double whole_j = energy_j(curve, duration_s);
    const double mean_w = whole_j / duration_s;
    const double curve_flown_w = flown_j / flown_s;
    const double curve_remaining_w = (whole_j - flown_j) / remaining_s;
    const bool by_curve = prior == CruisePrior::curve;
    const auto& spread = *cruise.model.level_spread;
    const DriftProcess drift{spread.drift_sd_w, spread.correlation_s};
    const CruiseVariances of{spread.between_flight_sd_w * spread.between_flight_sd_w,
                             variance_of_mean_w2(drift, flown_s), variance_of_mean_w2(drift, remaining_s),
                             covariance_of_means_w2(drift, flown_s, remaining_s)};
    // Without any variance between and within flights the model holds, whatever is measured.
    const double gain =
        of.flown_w2() > 0.0 ? std::min((of.level_w2 + of.drift_covariance_w2) / of.flown_w2(), 1.0) : 0.0;
    rest.gain = gain;
    rest.expected_w = by_curve ? curve_flown_w : mean_w;
    rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown_s;
    rest.remaining_mean_w = (by_curve ? curve_remaining_w : mean_w) + gain * (rest.measured_w - rest.expected_w);
    rest.energy.energy_wh = units::wh_from_joule(rest.remaining_mean_w * remaining_s);
    // The error's independent causes (docs/methods.md, Eq. 20). All rest on the flights, less one for their average:
    // the drift differs between flights, so that more samples of a flight do not count more.
    const auto freedom = static_cast<double>(spread.flights - 1);
    const double average = 1.0 + cruise.weight_square_sum;
    const double drift_w2 =
        std::max(0.0, of.remaining_drift_w2 - 2.0 * gain * of.drift_covariance_w2 + gain * gain * of.flown_drift_w2);
    const double shape_w = by_curve ? 0.0 : curve_remaining_w - mean_w - gain * (curve_flown_w - mean_w);
    const double wh2_per_w2 = std::pow(units::wh_from_joule(remaining_s), 2);
    for (const double variance_w2 : {average * (1.0 - gain) * (1.0 - gain) * of.level_w2, average * drift_w2,
                                     shape_w * shape_w, average * gain_variance_w2(of, freedom)})
        add_variance(rest.energy, variance_w2 * wh2_per_w2, freedom);
    return rest;
}

std::vector<RemainingCruise> predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                                        std::span<const MotionAhead> ahead) {
    if (!model.level_sd) throw NoResultError("the physical model has no variability between flights: fit two or more");
    std::vector<FlightBin> cruise;
    std::ranges::copy_if(flown.motion.bins, std::back_inserter(cruise),
                         [](const FlightBin& bin) { return bin.phase == flight::Phase::cruise; });
    const double expected_w = std::max(sum_of_terms_w(model, mean_values(cruise)), 0.0);
    const auto powers = predict_posterior_power(model, flown.motion.bins, flown.until_s, ahead);
    std::vector<RemainingCruise> rests(ahead.size());
    for (std::size_t i = 0; i < ahead.size(); ++i) {
        if (ahead[i].duration_s == 0.0) continue;
        const auto& power = powers[i];
        const double wh_per_w = units::wh_from_joule(ahead[i].duration_s);
        auto& rest = rests[i];
        rest.gain = power.level;
        rest.expected_w = expected_w;
        rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
        rest.remaining_mean_w = power.mean_w;
        rest.energy.energy_wh = power.mean_w * wh_per_w;
        add_variance(rest.energy, std::pow(power.parameter_sd_w * wh_per_w, 2), model.degrees_of_freedom);
        add_variance(rest.energy, std::pow(power.drift_sd_w * wh_per_w, 2), model.drift_degrees_of_freedom);
    }
    return rests;
}
RemainingCruise predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                           const MotionAhead& ahead) {
    return predict_remaining_physical(model, flown, std::span(&ahead, 1)).front();
}

}  // namespace flightwatt::mechanical
