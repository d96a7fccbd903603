#include "mechanical/prediction.h"

#include "base/error.h"
#include "base/units.h"
#include "mechanical/physical/power_regression.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace flightwatt::mechanical {
namespace {

/// Of the flights that count.
std::vector<double> durations_s(const MechanicalModel& model, flight::Phase phase) {
    std::vector<double> flown_s;
    for (const auto& flight : model.flights)
        if (const auto& part = flight.phases[phase]; part && part->weight > 0.0) flown_s.push_back(part->duration_s);
    return flown_s;
}

/// Half width of the 95 % interval of a phase's mean power; std::nullopt of a single flight.
std::optional<double> mean_power_half_width_w(const WeightedPhase& phase) {
    const auto& spread = phase.model.level_spread;
    if (!spread) return std::nullopt;
    return student_t_half_width(static_cast<double>(spread->flights - 1)) * spread->between_flight_sd_w *
           std::sqrt(phase.weight_square_sum);
}

using flight::Phase;
using PhaseVector = Eigen::Vector3d;
using PhaseMatrix = Eigen::Matrix3d;

/// Each phase's mean power about its expectation, by causes [W^2]; zeros where nothing was measured.
struct PhaseVariances {
    PhaseMatrix level_w2 = PhaseMatrix::Zero();         ///< between flights
    PhaseMatrix level_change_w2 = PhaseMatrix::Zero();  ///< by one standard error of the correlations
    PhaseVector flown_w2 = PhaseVector::Zero();         ///< drift, of the phase in progress, and the phase's boundary
    PhaseVector remaining_w2 = PhaseVector::Zero();
    PhaseVector both_w2 = PhaseVector::Zero();  ///< its covariance of the flown and the remaining part
    PhaseVector was_flown = PhaseVector::Zero();
};

/// Weights of the measured deviations (columns) in those ahead (rows).
struct Update {
    PhaseMatrix gains;
    PhaseMatrix seen_w2;          ///< covariance of what was measured
    PhaseMatrix by_variances;     ///< change of the gains with the logarithm of a variance
    PhaseMatrix by_correlations;  ///< with one standard error of the correlations
};

/// The inverse of a covariance; 0 along directions without any: without variance between and within flights the model
/// holds, whatever is measured.
PhaseMatrix pseudo_inverse(const PhaseMatrix& covariance) {
    const Eigen::SelfAdjointEigenSolver<PhaseMatrix> parts(covariance);
    const double least = 3.0 * std::numeric_limits<double>::epsilon() * parts.eigenvalues().cwiseAbs().maxCoeff();
    const PhaseVector inverse = (parts.eigenvalues().array() > least).select(parts.eigenvalues().cwiseInverse(), 0.0);
    return parts.eigenvectors() * inverse.asDiagonal() * parts.eigenvectors().transpose();
}

Update update_of(const PhaseVariances& of) {
    const auto seen = of.was_flown.asDiagonal();
    const PhaseMatrix level_w2 = seen * of.level_w2 * seen;
    const PhaseMatrix ahead_w2 = of.level_w2 * seen;
    Update update;
    update.seen_w2 = level_w2 + PhaseMatrix(of.flown_w2.asDiagonal());
    const PhaseMatrix inverse = pseudo_inverse(update.seen_w2);
    update.gains = (ahead_w2 + PhaseMatrix(of.both_w2.asDiagonal())) * inverse;
    update.by_variances = (ahead_w2 - update.gains * level_w2) * inverse;
    update.by_correlations = (of.level_change_w2 * seen - update.gains * seen * of.level_change_w2 * seen) * inverse;
    return update;
}

/// Expectations of the phases.
struct PhaseMeans {
    PhaseVector deviation_w = PhaseVector::Zero();    ///< measured less expected
    PhaseVector shape_flown_w = PhaseVector::Zero();  ///< the curve less the mean power, where that is the prior
    PhaseVector shape_ahead_w = PhaseVector::Zero();
};

/// Adds the error's independent causes for a sum of seconds ahead of each phase (docs/methods.md, Eq. 20). All rest on
/// the flights, less one for their average: the drift differs between flights, so more samples do not count more.
void add_causes(EnergyEstimate& estimate, const PhaseVector& ahead_s, const PhaseVariances& of, const Update& update,
                const PhaseMeans& means, double average, double freedom) {
    const PhaseVector weight_s = update.gains.transpose() * ahead_s;
    const PhaseVector level_s = ahead_s - weight_s;
    const double drift_j2 = (ahead_s.array().square() * of.remaining_w2.array() -
                             2.0 * ahead_s.array() * weight_s.array() * of.both_w2.array() +
                             weight_s.array().square() * of.flown_w2.array())
                                .sum();
    const auto gain_j2 = [&](const PhaseMatrix& change) {
        const PhaseVector change_s = change.transpose() * ahead_s;
        return change_s.dot(update.seen_w2 * change_s);
    };
    const double shape_j = ahead_s.dot(means.shape_ahead_w) - weight_s.dot(means.shape_flown_w);
    const double gains_j2 = 4.0 / freedom * gain_j2(update.by_variances) + gain_j2(update.by_correlations);
    for (const double variance_j2 : {average * level_s.dot(of.level_w2 * level_s), average * std::max(0.0, drift_j2),
                                     shape_j * shape_j, average * gains_j2})
        add_variance(estimate, std::max(0.0, variance_j2) * std::pow(units::wh_from_joule(1.0), 2), freedom);
}

/// In flight the moment between take-off and cruise is known to a second: of each flown phase's mean power, that second
/// has the other's.
void add_boundary(PhaseVariances& of, const flight::PerPhase<FlownPhase>& flown,
                  const flight::PerPhase<RemainingCruise>& phases) {
    constexpr double boundary_s = 1.0;
    const double step_j = boundary_s * (phases[Phase::takeoff].expected_w - phases[Phase::cruise].expected_w);
    for (const auto phase : {Phase::takeoff, Phase::cruise})
        if (flown[Phase::takeoff].duration_s > 0.0 && flown[phase].duration_s > 0.0)
            of.flown_w2[static_cast<Eigen::Index>(phase)] += std::pow(step_j / flown[phase].duration_s, 2);
}

/// Correlations with m flights are as uncertain as with this many more, in which phases do not correlate.
constexpr double prior_flights = 3.0;

/// Of level and drift; the correlations of a phase's level with the phases before it, which are set.
void set_variances(PhaseVariances& of, Phase phase, const flight::PerPhase<std::optional<WeightedPhase>>& model,
                   const PhaseCorrelations& correlations, double flown_s, double remaining_s) {
    const auto i = static_cast<Eigen::Index>(phase);
    const auto& spread = *model[phase]->model.level_spread;
    of.was_flown[i] = flown_s > 0.0 ? 1.0 : 0.0;
    of.level_w2(i, i) = spread.between_flight_sd_w * spread.between_flight_sd_w;
    for (const auto other : flight::all_phases) {
        const auto j = static_cast<Eigen::Index>(other);
        if (j >= i || !(of.level_w2(j, j) > 0.0)) continue;
        const double product_w2 = std::sqrt(of.level_w2(i, i) * of.level_w2(j, j));
        const double correlation = correlations[phase][other];
        const double error =
            (1.0 - correlation * correlation) / std::sqrt(static_cast<double>(spread.flights) - 1.0 + prior_flights);
        of.level_w2(i, j) = of.level_w2(j, i) = correlation * product_w2;
        of.level_change_w2(i, j) = of.level_change_w2(j, i) = correlation == 0.0 ? 0.0 : error * product_w2;
    }
    // The mean power of a whole phase differs between flights by its level and its drift together.
    if (!(flown_s > 0.0 && remaining_s > 0.0)) return;
    const DriftProcess drift{spread.drift_sd_w, spread.correlation_s};
    of.flown_w2[i] = variance_of_mean_w2(drift, flown_s);
    of.remaining_w2[i] = variance_of_mean_w2(drift, remaining_s);
    of.both_w2[i] = covariance_of_means_w2(drift, flown_s, remaining_s);
}

void set_means(PhaseMeans& means, RemainingCruise& rest, Phase phase, const PhaseModel& model, const FlownPhase& flown,
               double remaining_s, CruisePrior prior) {
    const auto i = static_cast<Eigen::Index>(phase);
    const double duration_s = flown.duration_s + remaining_s;
    const auto curve = time_scaled_model(model, duration_s, PhaseTimeScaling::scaled);
    const double flown_j = energy_j(curve, flown.duration_s);
    const double whole_j = energy_j(curve, duration_s);
    const double mean_w = whole_j / duration_s;
    const double curve_flown_w = flown.duration_s > 0.0 ? flown_j / flown.duration_s : mean_w;
    const double curve_remaining_w = remaining_s > 0.0 ? (whole_j - flown_j) / remaining_s : mean_w;
    const bool by_curve = prior == CruisePrior::curve;
    rest.expected_w = by_curve ? curve_flown_w : mean_w;
    rest.remaining_mean_w = by_curve ? curve_remaining_w : mean_w;
    rest.beyond_w = mean_w - rest.remaining_mean_w;
    if (flown.duration_s > 0.0) {
        rest.measured_w = units::joule_from_wh(flown.energy_wh) / flown.duration_s;
        means.deviation_w[i] = rest.measured_w - rest.expected_w;
    }
    if (by_curve) return;
    means.shape_flown_w[i] = curve_flown_w - mean_w;
    means.shape_ahead_w[i] = curve_remaining_w - mean_w;
}

/// 0 where either does not vary, or of fewer than three flights.
double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() < 3) return 0.0;
    const Eigen::Map<const Eigen::ArrayXd> first(a.data(), std::ssize(a));
    const Eigen::Map<const Eigen::ArrayXd> second(b.data(), std::ssize(b));
    const Eigen::ArrayXd from_first = first - first.mean();
    const Eigen::ArrayXd from_second = second - second.mean();
    const double norm = std::sqrt(from_first.square().sum() * from_second.square().sum());
    const auto freedom = static_cast<double>(a.size() - 1);
    return norm > 0.0 ? (from_first * from_second).sum() / norm * freedom / (freedom + prior_flights) : 0.0;
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

std::optional<Interval> interval_95(const EnergyEstimate& estimate) {
    if (!estimate.uncertainty_known) return std::nullopt;
    double half_wh = 0.0;
    if (estimate.variance_wh2 > 0.0) {
        const double degrees_of_freedom = estimate.variance_wh2 * estimate.variance_wh2 / estimate.satterthwaite_sum;
        half_wh = student_t_half_width(degrees_of_freedom) * std::sqrt(estimate.variance_wh2);
    }
    return Interval{std::max(estimate.energy_wh - half_wh, std::min(estimate.energy_wh, 0.0)),
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
    if (const auto half_w = mean_power_half_width_w(forecast))
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

PhaseCorrelations correlate_phases(std::span<const flight::PerPhase<std::optional<double>>> mean_powers_w) {
    PhaseCorrelations correlations;
    for (const auto a : flight::all_phases) {
        for (const auto b : flight::all_phases) {
            std::vector<double> of_a;
            std::vector<double> of_b;
            for (const auto& flight : mean_powers_w) {
                if (!flight[a] || !flight[b]) continue;
                of_a.push_back(*flight[a]);
                of_b.push_back(*flight[b]);
            }
            correlations[a][b] = a == b ? 1.0 : correlation_of(of_a, of_b);
        }
    }
    return correlations;
}

PhaseCorrelations correlate_phases(const MechanicalModel& model) {
    std::vector<flight::PerPhase<std::optional<double>>> mean_powers_w(model.flights.size());
    for (std::size_t i = 0; i < model.flights.size(); ++i)
        for (const auto phase : flight::all_phases)
            if (const auto& part = model.flights[i].phases[phase]) mean_powers_w[i][phase] = part->mean_power_w;
    return correlate_phases(mean_powers_w);
}

EnergyEstimate sum_of(const flight::PerPhase<std::optional<EnergyEstimate>>& phases,
                      const PhaseCorrelations& correlations) {
    EnergyEstimate sum;
    double variance_wh2 = 0.0;
    for (const auto a : flight::all_phases) {
        if (!phases[a]) continue;
        sum = sum_of(sum, *phases[a]);
        for (const auto b : flight::all_phases)
            if (phases[b])
                variance_wh2 += correlations[a][b] * std::sqrt(phases[a]->variance_wh2 * phases[b]->variance_wh2);
    }
    if (!(sum.variance_wh2 > 0.0)) return sum;
    const double factor = std::max(variance_wh2, 0.0) / sum.variance_wh2;
    sum.variance_wh2 *= factor;
    sum.satterthwaite_sum *= factor * factor;
    return sum;
}

RemainingFlight predict_remaining_flight(const flight::PerPhase<std::optional<WeightedPhase>>& model,
                                         const PhaseCorrelations& correlations,
                                         const flight::PerPhase<FlownPhase>& flown,
                                         const flight::PerPhase<double>& remaining_s, CruisePrior prior) {
    RemainingFlight rest;
    PhaseVariances of;
    PhaseMeans means;
    double average = 1.0;
    double freedom = std::numeric_limits<double>::infinity();
    for (const auto phase : flight::all_phases) {
        if (flown[phase].duration_s + remaining_s[phase] <= 0.0) continue;
        if (!model[phase]->model.level_spread)
            throw NoResultError("the model has no variability between flights: fit two flights or more");
        set_variances(of, phase, model, correlations, flown[phase].duration_s, remaining_s[phase]);
        set_means(means, rest.phases[phase], phase, model[phase]->model, flown[phase], remaining_s[phase], prior);
        average = std::max(average, 1.0 + model[phase]->weight_square_sum);
        freedom = std::min(freedom, static_cast<double>(model[phase]->model.level_spread->flights - 1));
    }
    add_boundary(of, flown, rest.phases);
    const auto update = update_of(of);
    const PhaseVector change_w = update.gains * means.deviation_w;
    const PhaseVector ahead_s(remaining_s.values.data());
    for (const auto phase : flight::all_phases) {
        if (!(remaining_s[phase] > 0.0)) continue;
        const auto i = static_cast<Eigen::Index>(phase);
        auto& part = rest.phases[phase];
        part.gain = update.gains(i, i);
        part.remaining_mean_w += change_w[i];
        part.energy.energy_wh = units::wh_from_joule(part.remaining_mean_w * remaining_s[phase]);
        add_causes(part.energy, PhaseVector::Unit(i) * remaining_s[phase], of, update, means, average, freedom);
        rest.total.energy_wh += part.energy.energy_wh;
    }
    add_causes(rest.total, ahead_s, of, update, means, average, freedom);
    return rest;
}

}  // namespace flightwatt::mechanical
