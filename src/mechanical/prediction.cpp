#include "mechanical/prediction.h"

#include "base/error.h"
#include "base/units.h"
#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flightwatt::mechanical {
namespace {

/// Of the flights that count.
std::vector<double> durations_s(const MechanicalModel& model, flight::Phase phase) {
    std::vector<double> flown_s;
    for (const auto& flight : model.flights)
        if (const auto& part = flight.phases[phase]; part && part->weight > 0.0) flown_s.push_back(part->duration_s);
    return flown_s;
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

DurationEstimate estimate_duration(const MechanicalModel& model, flight::Phase phase, double planned_s) {
    const auto flown_s = durations_s(model, phase);
    if (flown_s.size() < 2) return {planned_s};
    const double relative_sd = sample_sd(flown_s) / mean(flown_s);
    return {planned_s, planned_s * relative_sd * std::sqrt(1.0 + forecast_of(model, phase).weight_square_sum),
            static_cast<double>(flown_s.size() - 1)};
}

DurationEstimate estimate_duration_after_takeoff(const MechanicalModel& model, flight::Phase phase, double planned_s,
                                                 double takeoff_s) {
    auto estimate = estimate_duration(model, phase, planned_s);
    const auto takeoffs_s = durations_s(model, flight::Phase::takeoff);
    if (takeoffs_s.size() < 2) return estimate;
    std::vector<flight::PerPhase<std::optional<double>>> flown_s(model.flights.size());
    for (std::size_t i = 0; i < flown_s.size(); ++i)
        for (const auto of : {flight::Phase::takeoff, phase})
            if (const auto& part = model.flights[i].phases[of]; part && part->weight > 0.0)
                flown_s[i][of] = part->duration_s;
    const double correlation = correlate_phases(flown_s)[flight::Phase::takeoff][phase];
    const double sd_s = sample_sd(takeoffs_s);
    if (correlation == 0.0 || !(sd_s > 0.0)) return estimate;
    const double deviation = (takeoff_s - mean(takeoffs_s)) / sd_s;
    const double of_flights_s = estimate.sd_s / std::sqrt(1.0 + forecast_of(model, phase).weight_square_sum);
    estimate.mean_s = std::max(0.0, planned_s + correlation * deviation * of_flights_s);
    estimate.sd_s *= std::sqrt((1.0 - correlation * correlation) *
                               (1.0 + deviation * deviation / static_cast<double>(takeoffs_s.size())));
    return estimate;
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
        if (flown.cruise_s() > 0.0) rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
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
