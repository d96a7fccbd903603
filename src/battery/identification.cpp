#include "battery/identification.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"
#include "battery/identification/circuit_problem.h"
#include "battery/identification/open_circuit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double looked_ahead_s = 30.0;
constexpr double unreadable_v = 0.01;  // smaller differences between resting voltages are not significant

const DischargeRecord& fullest_of(std::span<const DischargeRecord> records) {
    return *std::ranges::max_element(records, {}, &DischargeRecord::resting_voltage_v);
}

/// A circuit with its errors, and what each flight adds.
struct FittedFlights {
    JointCircuitFit aligned;
    CircuitErrors errors;
    std::vector<std::optional<FlightResistance>> resistances;
    std::vector<std::optional<FlightCapacity>> capacities;
};

/// From three flights on the resistance's interval is at least that of the mean of the flights' own.
void widen_by_flights(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm,
                      Interval& interval_ohm) {
    std::vector<double> own_ohm;
    for (const auto& own : resistances)
        if (own) own_ohm.push_back(own->value_ohm);
    if (own_ohm.size() < 3) return;
    const auto flights = static_cast<double>(own_ohm.size());
    const double half_ohm = student_t_half_width(flights - 1.0) * sample_sd(own_ohm) / std::sqrt(flights);
    interval_ohm.low = std::min(interval_ohm.low, std::max(0.0, fitted_ohm - half_ohm));
    interval_ohm.high = std::max(interval_ohm.high, fitted_ohm + half_ohm);
}

void add_health(FittedFlights& fitted, bool with_capacities) {
    auto& errors_ah = fitted.errors.initial_charge_error_ah;
    const auto health = estimate_state_of_health(fitted.aligned, with_capacities);
    for (std::size_t f = 0; f < health.size(); ++f) {
        fitted.resistances.push_back(health[f].resistance);
        fitted.capacities.push_back(health[f].capacity);
        errors_ah[f] = std::max(errors_ah[f], health[f].initial_charge_error_ah);
    }
    widen_by_flights(fitted.resistances, fitted.aligned.fit.resistance_ohm, fitted.errors.resistance_ohm);
}

ObservedOcv shown_curve(const FittedFlights& fitted) {
    const auto& fit = fitted.aligned.fit;
    const auto& reference = fitted.aligned.records[fitted.aligned.reference];
    return {fit.knots_ah,
            fit.open_circuit_v,
            fitted.errors.open_circuit_covariance_v2,
            reference.initial_charge_ah,
            reference.record->resting_voltage_v,
            fit.weights.cells};
}

std::vector<IdentifiedFlight> identified_flights(const FittedFlights& fitted,
                                                 std::span<const CapacityHypothesis> posterior, double missing_ah) {
    std::vector<IdentifiedFlight> flights;
    for (std::size_t f = 0; f < fitted.aligned.records.size(); ++f) {
        const auto* record = fitted.aligned.records[f].record;
        const double offset_ah = fitted.aligned.records[f].initial_charge_ah;
        IdentifiedFlight flight;
        flight.flight = record->flight;
        flight.resting_voltage_v = record->resting_voltage_v;
        const double error_ah = fitted.errors.initial_charge_error_ah[f];
        const auto& [low_ah, high_ah] = flight.initial_charge_interval_ah =
            depletion_interval_ah(posterior, offset_ah, error_ah);
        flight.initial_depletion_ah = std::clamp(missing_ah + offset_ah, low_ah, high_ah);
        flight.drawn_ah = record->charge_ah.back();
        flight.resistance = fitted.resistances[f];
        flight.capacity = fitted.capacities[f];
        flight.air_temperature_c = record->air_temperature_c;
        flight.samples = record->time_s.size();
        const auto residual = residual_v(fitted.aligned, f);
        flight.unused = flight.samples - static_cast<std::size_t>(residual.size());
        flight.voltage_rms_v = residual.norm() / std::sqrt(static_cast<double>(residual.size()));
        flights.push_back(std::move(flight));
    }
    return flights;
}

/// The results common to all flights, with their intermediate fits.
struct IdentificationResult {
    BatteryIdentification identification;
    FittedFlights fitted;
    std::vector<CapacityHypothesis> posterior;
};

int cells_of(std::span<const DischargeRecord> records, const IdentificationOptions& options) {
    return options.cells.value_or(lipo_cells(fullest_of(records).resting_voltage_v));
}

/// Throws UsageError with the flight that ends with the most charge missing from the pack: more than the capacity.
[[noreturn]] void refuse_capacity(const JointCircuitFit& aligned, double capacity_ah) {
    const auto missing_ah = [](const AlignedRecord& record) {
        return record.initial_charge_ah + record.record->charge_ah.back();
    };
    const auto& deepest = *std::ranges::max_element(aligned.records, {}, missing_ah);
    const double drawn_ah = deepest.record->charge_ah.back();
    constexpr double significant = 0.01;  // of the charge drawn
    const auto& flight = deepest.record->flight;
    if (deepest.initial_charge_ah < significant * drawn_ah)
        throw UsageError(fmt::format("--capacity is {} Ah, and {} drew {:.3f} Ah", capacity_ah, flight, drawn_ah));
    throw UsageError(fmt::format(
        "--capacity is {} Ah, and {:.3f} Ah are missing from the pack at the end of {}: {:.3f} Ah were drawn, and "
        "{:.3f} Ah missing before are inferred from its voltage, by the curve of all flights (the fullest is {}); "
        "expected more, or --exclude {} if its pack was another",
        capacity_ah, missing_ah(deepest), flight, drawn_ah, deepest.initial_charge_ah,
        aligned.records[aligned.reference].record->flight, flight));
}

/// Without the flights' health.
IdentificationResult identify_common(JointCircuitFit aligned, const IdentificationOptions& options) {
    IdentificationResult common;
    common.fitted.errors = circuit_errors(aligned);
    common.fitted.aligned = std::move(aligned);
    common.posterior = capacity_posterior(shown_curve(common.fitted), options.capacity_ah);
    if (common.posterior.empty()) refuse_capacity(common.fitted.aligned, options.capacity_ah.value_or(0.0));
    const auto& [identification, fitted, posterior] = common;
    auto& result = common.identification;
    const auto& fit = result.fit = fitted.aligned.fit;
    const auto& errors = fitted.errors;
    result.cells = fit.weights.cells;
    result.cells_are_given = options.cells.has_value();
    result.capacity = estimate_capacity(fit.knots_ah.back(), posterior, options.capacity_ah);
    result.chemistry = most_probable_chemistry(posterior);
    result.curve_start_depletion_ah = estimate_depletion_ah(posterior);
    const auto extended = extrapolate_curve(fit, errors.open_circuit_standard_error_v, result.chemistry,
                                            result.capacity.value_ah, result.curve_start_depletion_ah);
    result.observed_min_soc_percent = extended.known_down_to_percent;
    result.observed_max_soc_percent = extended.known_up_to_percent;
    auto& battery = result.battery;
    battery.name = options.name;
    battery.resistance_ohm = fit.resistance_ohm;
    battery.capacity_ah = result.capacity.value_ah;
    battery.cells = result.cells;
    battery.thevenin = TheveninCircuit{extended.curve, fit.rc_resistance_ohm, std::max(0.1, fit.rc_time_constant_s)};
    battery.intervals.capacity_ah = result.capacity.interval_ah;
    battery.intervals.open_circuit_standard_error_v = extended.standard_error_v;
    if (fit.rc_resistance_ohm > 0.0) {
        battery.intervals.rc_resistance_ohm = errors.rc_resistance_ohm;
        battery.intervals.rc_time_constant_s = errors.rc_time_constant_s;
    }
    return common;
}

/// The capacity that the flights indicate without a given one; nullptr where they drew too little.
std::shared_ptr<const FlightEstimate> flight_estimate(const IdentificationResult& common) {
    const auto& [identification, fitted, posterior] = common;
    const auto& fit = identification.fit;
    const bool is_given = identification.capacity.origin == CapacityOrigin::given;
    auto estimate = std::make_shared<FlightEstimate>();
    for (const auto& aligned : fitted.aligned.records) estimate->flights.push_back(aligned.record->flight);
    try {
        const auto free = is_given ? capacity_posterior(shown_curve(fitted), std::nullopt) : posterior;
        const auto capacity = estimate_capacity(fit.knots_ah.back(), free, std::nullopt);
        estimate->capacity_ah = capacity.value_ah;
        estimate->capacity_interval_ah = capacity.interval_ah.value();
        if (!is_given) return estimate;
        estimate->open_circuit =
            extrapolate_curve(fit, identification.errors.open_circuit_standard_error_v, most_probable_chemistry(free),
                              estimate->capacity_ah, estimate_depletion_ah(free))
                .curve;
        return estimate;
    } catch (const NoResultError&) {
        return nullptr;
    }
}

/// The initial charge of a record by its resting voltage: as far below the reference as it rests lower.
double resting_charge_ah(const DischargeRecord& record, const JointCircuitFit& aligned) {
    const auto& fit = aligned.fit;
    const auto& [reference, reference_ah, rest_v, own_ohm, log_capacity] = aligned.records[aligned.reference];
    const double resistance_ohm = fit.resistance_ohm + fit.rc_resistance_ohm;
    const double below_v = reference->resting_voltage_v - record.resting_voltage_v +
                           resistance_ohm * (reference->resting_current_a - record.resting_current_a);
    if (std::abs(below_v) <= std::max(unreadable_v, record.resolution_v)) return reference_ah;
    const double reference_v = interpolate_clamped(fit.knots_ah, fit.open_circuit_v, reference_ah);
    // The inverse of the curve, which falls.
    const std::vector<double> rising_v(fit.open_circuit_v.rbegin(), fit.open_circuit_v.rend());
    const std::vector<double> falling_ah(fit.knots_ah.rbegin(), fit.knots_ah.rend());
    return interpolate_clamped(rising_v, falling_ah, reference_v - below_v);
}

/// Measured less predicted [V] at used samples from the index `first` on. Before the first load the voltage is
/// `above_v` above the curve.
Eigen::VectorXd errors_v(const std::vector<double>& predicted_v, const DischargeRecord& record, std::size_t first,
                         double above_v = 0.0) {
    std::vector<double> errors;
    for (std::size_t i = first; i < predicted_v.size(); ++i) {
        const double rest_v = i < record.rest_samples ? above_v : 0.0;
        if (record.used[i]) errors.push_back(record.voltage_v[i] - predicted_v[i] - rest_v);
    }
    return Eigen::Map<const Eigen::VectorXd>(errors.data(), std::ssize(errors));
}

double root_mean_square(const Eigen::VectorXd& values) {
    return values.norm() / std::sqrt(std::max(1.0, static_cast<double>(values.size())));
}

/// The voltage of a record in flight, predicted `ahead_s` before each sample: offset, resistance and slope of the curve
/// follow the samples from the first load to then (docs/methods.md, Eq. 27c).
std::vector<double> predict_voltage_ahead(const Battery& battery, const DischargeRecord& record,
                                          const std::vector<double>& model_v, double ahead_s) {
    constexpr double memory_s = 20.0;          // a sample counts by exp(-age / memory_s)
    constexpr double slope_sd_v = 0.6;         // a cell, of the fall of the curve from full to empty
    constexpr double sample_sd_v = 0.01;       // a cell, of the voltage about the circuit
    constexpr double sample_settling_s = 3.0;  // for which neighbours share that error
    const auto first = record.rest_samples;
    const int cells = battery.cells.value_or(1);
    const auto settled_a = rc_branch_current_a(record, battery.thevenin.value().rc_time_constant_s);
    const auto row = [&](std::size_t i) {  // derivatives by offset [V], relative resistance and slope [V/Ah]
        const double rc_v = battery.thevenin->rc_resistance_ohm * settled_a[i];
        return Eigen::Vector3d(1.0, -battery.resistance_ohm * record.current_a[i] - rc_v,
                               record.charge_ah[first] - record.charge_ah[i]);
    };
    const Eigen::Vector3d prior_sd(cells * chart_sd_v, default_scatter_fraction,
                                   cells * slope_sd_v / battery.capacity_ah);
    const Eigen::Matrix3d prior = prior_sd.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d score = Eigen::Vector3d::Zero();
    auto voltage_v = model_v;
    std::size_t next = first;  // the first sample that is not known yet
    for (std::size_t i = first; i < voltage_v.size(); ++i) {
        for (; record.time_s[next] <= record.time_s[i] - ahead_s; ++next) {
            const double step_s = record.time_s[next] - record.time_s[std::max<std::size_t>(next, 1) - 1];
            const double decay = std::exp(-step_s / memory_s);
            const double share = record.used[next] ? std::min(step_s / sample_settling_s, 1.0) : 0.0;
            const Eigen::Vector3d weighted = share / std::pow(cells * sample_sd_v, 2) * row(next);
            information = decay * information + weighted * row(next).transpose();
            score = decay * score + (record.voltage_v[next] - model_v[next]) * weighted;
        }
        if (next > first) voltage_v[i] += row(i).dot((prior + information).inverse() * score);
    }
    return voltage_v;
}

double beyond_percent(const BatteryIdentification& identified, const DischargeRecord& record,
                      const PredictedVoltage& predicted) {
    double beyond = 0.0;
    for (std::size_t i = 0; i < record.time_s.size(); ++i)
        if (record.used[i] && predicted.soc_percent[i] < identified.observed_min_soc_percent) beyond += 1.0;
    return units::percentage(beyond, static_cast<double>(used_sample_count(record)));
}

LeaveOneOutCheck checked(const IdentificationResult& common, const DischargeRecord& record) {
    const auto& identified = common.identification;
    LeaveOneOutCheck check;
    check.flight = record.flight;
    check.initial_charge_ah = identified.curve_start_depletion_ah + resting_charge_ah(record, common.fitted.aligned);
    const auto predicted = predict_voltage(identified.battery, record, check.initial_charge_ah);
    check.voltage_rms_v =
        root_mean_square(errors_v(predicted.voltage_v, record, 0, identified.fit.common_rest_offset_v));
    const auto under_load = errors_v(predicted.voltage_v, record, record.rest_samples);
    check.load_rms_v = root_mean_square(under_load);
    check.load_mean_error_v = under_load.cwiseAbs().mean();
    const auto first = std::ranges::lower_bound(record.time_s, record.time_s[record.rest_samples] + looked_ahead_s);
    const auto ahead = errors_v(predict_voltage_ahead(identified.battery, record, predicted.voltage_v, looked_ahead_s),
                                record, static_cast<std::size_t>(first - record.time_s.begin()));
    check.ahead_error_v = ahead.size() > 0 ? ahead.cwiseAbs().mean() : 0.0;
    check.extrapolated_percent = beyond_percent(identified, record, predicted);
    return check;
}

}  // namespace

BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options) {
    if (records.empty()) throw NoResultError("no flight is left to identify a battery from");
    const auto& fullest = fullest_of(records);
    if (options.cells) require_possible_cells(fullest.flight, fullest.resting_voltage_v, *options.cells);
    auto common = identify_common(fit_circuit_jointly(records, cells_of(records, options)), options);
    auto& [result, fitted, posterior] = common;
    add_health(fitted, options.with_capacities);
    result.errors = fitted.errors;
    result.battery.intervals.resistance_ohm = fitted.errors.resistance_ohm;
    result.battery.intervals.resistance_scatter = resistance_scatter(fitted.resistances, result.fit.resistance_ohm);
    result.flights = identified_flights(fitted, posterior, result.curve_start_depletion_ah);
    result.battery.flight_estimate = flight_estimate(common);
    return std::move(result);
}

PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record, double initial_charge_ah) {
    const auto& circuit = battery.thevenin.value();
    const auto settled_a = rc_branch_current_a(record, circuit.rc_time_constant_s);
    PredictedVoltage predicted;
    predicted.soc_percent.reserve(record.time_s.size());
    predicted.voltage_v.reserve(record.time_s.size());
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double drawn_ah = initial_charge_ah + record.charge_ah[i];
        const BatteryState state{units::percent_per_whole - units::percentage(drawn_ah, battery.capacity_ah),
                                 circuit.rc_resistance_ohm * settled_a[i]};
        predicted.soc_percent.push_back(state.soc_percent);
        predicted.voltage_v.push_back(terminal_voltage_v(battery, state, record.current_a[i]));
    }
    return predicted;
}

std::vector<LeaveOneOutCheck> leave_one_out(std::span<const DischargeRecord> records,
                                            const IdentificationOptions& options,
                                            const std::function<void(std::size_t, std::size_t)>& progress,
                                            std::size_t max_folds) {
    if (records.size() < 2) return {};
    const auto folds = make_folds(records.size(), std::max<std::size_t>(2, max_folds));
    const auto all = fit_circuit_jointly(records, cells_of(records, options));
    std::vector<LeaveOneOutCheck> checks(records.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    for_each_in_parallel(folds.size(), [&](std::size_t fold) {
        const auto common = identify_common(fit_without(all, folds[fold]), options);
        for (const auto k : folds[fold]) checks[k] = checked(common, records[k]);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(++done, folds.size());
    });
    return checks;
}

}  // namespace flightwatt::battery
