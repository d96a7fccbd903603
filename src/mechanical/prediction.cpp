#include "mechanical/prediction.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flightwatt::mechanical {
namespace {

/// What was expected of a cruise, in flight.
struct Expectation {
    double flown_w = 0.0;
    double remaining_w = 0.0;
    double level_sd_w = 0.0;
    double weight_square_sum = 1.0;
    double degrees_of_freedom = 1.0;  ///< of level_sd_w
    double shape_flown_w = 0.0;       ///< what the curve says beyond `measured_w`, where its shape is not believed
    double shape_remaining_w = 0.0;
};

Expectation expect_by_curve(const WeightedPhase& cruise, double flown_s, double remaining_s) {
    const double duration_s = flown_s + remaining_s;
    const auto curve = time_scaled_model(cruise.model, duration_s, PhaseTimeScaling::stretched);
    const double flown_j = energy_j(curve, flown_s);
    const auto& spread = *cruise.model.level_spread;
    return {flown_j / flown_s, (energy_j(curve, duration_s) - flown_j) / remaining_s, spread.between_flight_sd_w,
            cruise.weight_square_sum, static_cast<double>(spread.flights - 1)};
}

Expectation expect(const WeightedPhase& cruise, const FlightProgress& flown, double remaining_s, CruisePrior source) {
    const double flown_s = flown.cruise_s();
    auto expected = expect_by_curve(cruise, flown_s, remaining_s);
    if (source == CruisePrior::curve) return expected;
    const double mean_w = (expected.flown_w * flown_s + expected.remaining_w * remaining_s) / (flown_s + remaining_s);
    expected.shape_flown_w = expected.flown_w - mean_w;
    expected.shape_remaining_w = expected.remaining_w - mean_w;
    expected.flown_w = expected.remaining_w = mean_w;
    return expected;
}

/// The variances [W^2] of the mean powers x (flown) and y (remaining) less what was expected, by their causes.
struct Variances {
    double level_w2 = 0.0;
    double flown_drift_w2 = 0.0;
    double remaining_drift_w2 = 0.0;
    double drift_covariance_w2 = 0.0;
};

/// To first order: level and drift are themselves estimated, with relative variances 2 / degrees of freedom,
/// and the gain changes oppositely with the logarithms of both.
double variance_of_gain(const Variances& of, double level_degrees_of_freedom, double drift_degrees_of_freedom) {
    const double flown_w2 = of.level_w2 + of.flown_drift_w2;
    if (!(flown_w2 > 0.0)) return 0.0;
    const double change = of.level_w2 * (of.flown_drift_w2 - of.drift_covariance_w2) / (flown_w2 * flown_w2);
    return change * change * (2.0 / level_degrees_of_freedom + 2.0 / drift_degrees_of_freedom);
}

/// The variance of the error y - gain x, share by share (docs/methods.md, Eq. 20).
void add_shares(RemainingCruise& rest, const Expectation& expected, const Variances& of,
                double drift_degrees_of_freedom, double remaining_s) {
    const double wh2_per_w2 = std::pow(units::wh_from_joule(remaining_s), 2);
    const double gain = rest.gain;
    auto& energy = rest.energy;
    const double average = 1.0 + expected.weight_square_sum;
    const double kept = 1.0 - gain;
    const double drift_w2 =
        std::max(0.0, of.remaining_drift_w2 - 2.0 * gain * of.drift_covariance_w2 + gain * gain * of.flown_drift_w2);
    const double gain_w2 =
        (of.level_w2 + of.flown_drift_w2) * variance_of_gain(of, expected.degrees_of_freedom, drift_degrees_of_freedom);
    const double shape_w = expected.shape_remaining_w - gain * expected.shape_flown_w;
    add_variance(energy, {average * kept * kept * of.level_w2 * wh2_per_w2, expected.degrees_of_freedom});
    add_variance(energy, {average * drift_w2 * wh2_per_w2, drift_degrees_of_freedom});
    add_variance(energy, {shape_w * shape_w * wh2_per_w2, drift_degrees_of_freedom});
    add_variance(energy,
                 {average * gain_w2 * wh2_per_w2, std::min(expected.degrees_of_freedom, drift_degrees_of_freedom)});
}

/// Half the 95 % interval of a phase's mean power, where it is known.
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

void add_variance(EnergyEstimate& estimate, const VarianceTerm& share) {
    estimate.variance_wh2 += share.variance_wh2;
    if (share.variance_wh2 > 0.0) {
        estimate.satterthwaite_sum += share.variance_wh2 * share.variance_wh2 / share.degrees_of_freedom;
    }
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
    if (power.sd_w) {
        const double sd_wh = units::wh_from_joule(*power.sd_w * duration_s);
        add_variance(estimate, {sd_wh * sd_wh, power.degrees_of_freedom});
    }
    return estimate;
}

EnergyEstimate predict_remaining_before_flight(const WeightedPhase& phase, double flown_s, double remaining_s) {
    const double duration_s = flown_s + remaining_s;
    const auto curve = time_scaled_model(phase.model, duration_s, PhaseTimeScaling::stretched);
    const double rest_j = energy_j(curve, duration_s) - energy_j(curve, flown_s);
    EnergyEstimate estimate{units::wh_from_joule(rest_j), phase.model.level_spread.has_value(), 0.0, 0.0};
    if (!phase.model.level_spread) return estimate;
    const auto& spread = *phase.model.level_spread;
    const double sd_wh = units::wh_from_joule(spread.between_flight_sd_w * remaining_s);
    add_variance(estimate, {sd_wh * sd_wh * (1.0 + phase.weight_square_sum), static_cast<double>(spread.flights - 1)});
    return estimate;
}

RemainingCruise predict_remaining_cruise(const WeightedPhase& cruise, const FlightProgress& flown, double remaining_s,
                                         CruisePrior source) {
    if (!cruise.model.level_spread) {
        throw NoResultError("the model does not say how flights differ: fit two flights or more");
    }
    RemainingCruise rest;
    if (remaining_s == 0.0) return rest;
    const double flown_s = flown.cruise_s();
    const auto expected = expect(cruise, flown, remaining_s, source);
    const auto& spread = *cruise.model.level_spread;
    const DriftProcess drift{spread.drift_sd_w, spread.correlation_s};
    const Variances of{expected.level_sd_w * expected.level_sd_w, variance_of_mean_w2(drift, flown_s),
                       variance_of_mean_w2(drift, remaining_s), covariance_of_means_w2(drift, flown_s, remaining_s)};
    const double flown_w2 = of.level_w2 + of.flown_drift_w2;
    // Flights that are all alike, without any drift: the model is right, whatever is measured.
    rest.gain = flown_w2 > 0.0 ? std::min((of.level_w2 + of.drift_covariance_w2) / flown_w2, 1.0) : 0.0;
    rest.expected_w = expected.flown_w;
    rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown_s;
    rest.remaining_mean_w = expected.remaining_w + rest.gain * (rest.measured_w - rest.expected_w);
    rest.energy.energy_wh = units::wh_from_joule(rest.remaining_mean_w * remaining_s);
    // How much a flight drifts differs from flight to flight, so many samples are no more than their flights;
    // and the curve, their average, takes one.
    add_shares(rest, expected, of, static_cast<double>(spread.flights - 1), remaining_s);
    return rest;
}

EnergyEstimate predict_physical(const PhysicalModel& model, const TermValues& mean_values, double duration_s) {
    const double mean_w = std::max(sum_of_terms_w(model, mean_values), 0.0);
    const auto uncertainty = prediction_uncertainty(model, mean_values, duration_s);
    EnergyEstimate estimate{units::wh_from_joule(mean_w * duration_s), uncertainty.has_value(), 0.0, 0.0};
    if (!uncertainty) return estimate;
    const double sd_wh = units::wh_from_joule(uncertainty->sd_w * duration_s);
    add_variance(estimate, {sd_wh * sd_wh, uncertainty->degrees_of_freedom});
    return estimate;
}

std::vector<RemainingCruise> predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                                        std::span<const MotionAhead> ahead) {
    if (!model.level_sd) throw NoResultError("the physical model does not say how flights differ: fit two or more");
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
        add_variance(rest.energy, {std::pow(power.parameter_sd_w * wh_per_w, 2), power.parameter_degrees_of_freedom});
        add_variance(rest.energy, {std::pow(power.drift_sd_w * wh_per_w, 2), power.drift_degrees_of_freedom});
    }
    return rests;
}

RemainingCruise predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                           const MotionAhead& ahead) {
    return predict_remaining_physical(model, flown, std::span(&ahead, 1)).front();
}

}  // namespace flightwatt::mechanical
