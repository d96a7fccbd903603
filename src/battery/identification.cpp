#include "battery/identification.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "base/units.h"
#include "battery/identification/circuit_problem.h"
#include "battery/identification/open_circuit.h"
#include "battery/identification/voltage_forecast.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// Of two flights the resistance's interval has both of the flights' own; from three on it is at least that of their mean.
void widen_by_flights(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm,
                      Interval& interval_ohm) {
    std::vector<double> own_ohm;
    for (const auto& own : resistances)
        if (own) own_ohm.push_back(own->value_ohm);
    if (own_ohm.size() < 2) return;
    if (own_ohm.size() == 2) {
        interval_ohm.low = std::min({interval_ohm.low, own_ohm[0], own_ohm[1]});
        interval_ohm.high = std::max({interval_ohm.high, own_ohm[0], own_ohm[1]});
        return;
    }
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

/// The charge down to which flights determine the curve, with its standard error.
struct CurveEnd {
    double charge_ah = 0.0;
    double error_ah = 0.0;
};

/// Returns where the last flight ends that begins at a charge known within a quarter of the curve, or that drew so much
/// itself. Where the curve is flat, the charge at which a flight began may be any; the curve's end, and with it a
/// capacity, must not rest on it.
CurveEnd determined_end(const FittedFlights& fitted) {
    constexpr double known_fraction = 0.25;  // chosen with the M100's packs in view
    const double last_ah = fitted.aligned.fit.knots_ah.back();
    CurveEnd end;
    for (std::size_t f = 0; f < fitted.aligned.records.size(); ++f) {
        const auto& [record, initial_ah, rest_v, own_ohm, log_capacity] = fitted.aligned.records[f];
        const bool is_fixed = f == fitted.aligned.reference;
        const double error_ah = is_fixed ? 0.0 : fitted.errors.initial_charge_error_ah[f];
        const bool is_known = normal_half_width() * error_ah <= known_fraction * last_ah;
        const CurveEnd own{record->charge_ah.back() + (is_known ? initial_ah : 0.0), is_known ? error_ah : 0.0};
        if (own.charge_ah > end.charge_ah) end = own;
    }
    return {std::min(end.charge_ah, last_ah), end.error_ah};
}

/// Widens the interval of a capacity by the error of the charge over which the curve was compared with a chart: as that
/// charge, the capacity is a factor too great or too small.
void widen_by_end(Capacity& capacity, const CurveEnd& end) {
    if (!capacity.interval_ah) return;
    const double by = normal_half_width() * end.error_ah / end.charge_ah;
    const auto factor = [&](double bound_ah) {
        return std::exp(std::hypot(std::log(bound_ah / capacity.value_ah), by));
    };
    capacity.interval_ah = Interval{capacity.value_ah / factor(capacity.interval_ah->low),
                                    capacity.value_ah * factor(capacity.interval_ah->high)};
}

/// Cuts a curve and its errors at a charge, where they get a knot.
void cut_curve(CircuitFit& fit, CircuitErrors& errors, double end_ah) {
    if (end_ah >= fit.knots_ah.back()) return;
    const auto [lower, fraction] = find_knot_interval(fit.knots_ah, end_ah);
    const auto knots = static_cast<Eigen::Index>(lower) + 2;
    Eigen::MatrixXd between = Eigen::MatrixXd::Identity(knots, static_cast<Eigen::Index>(fit.knots_ah.size()));
    between.bottomRows(1).setZero();
    between(knots - 1, knots - 2) = 1.0 - fraction;
    between(knots - 1, knots - 1) = fraction;
    const auto cut = [&](std::vector<double>& values) {
        const Eigen::VectorXd kept = between * Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
        values.assign(kept.begin(), kept.end());
    };
    cut(fit.knots_ah);
    cut(fit.open_circuit_v);
    cut(errors.open_circuit_standard_error_v);
    errors.open_circuit_covariance_v2 = between * errors.open_circuit_covariance_v2 * between.transpose();
}

ObservedOcv shown_curve(const FittedFlights& fitted, const CircuitFit& fit, const CircuitErrors& errors) {
    const auto& reference = fitted.aligned.records[fitted.aligned.reference];
    return {fit.knots_ah,
            fit.open_circuit_v,
            errors.open_circuit_covariance_v2,
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
        flight.battery_temperature_c = record->battery_temperature_c;
        flight.battery_start_c = record->battery_start_c;
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
    CurveEnd end;
};

/// The number of cells, and where it is from.
struct CellChoice {
    int cells = 0;
    bool is_given = false;
    std::string warning = {};
};

CellChoice choose_cells(std::span<const DischargeRecord> records, const IdentificationOptions& options) {
    if (options.cells) return {*options.cells, true};
    std::set<int> stated;
    for (const auto& record : records)
        if (record.stated_cells) stated.insert(*record.stated_cells);
    const double rest_v = fullest_of(records).resting_voltage_v;
    const int usual = lipo_cells(rest_v);
    if (stated.empty()) return {usual, false};
    const auto states = fmt::format("the logs state {} cells", fmt::join(stated, " and "));
    if (stated.size() > 1)
        return {usual, false, fmt::format("{}: {} are assumed; --cells states the number", states, usual)};
    const int cells = *stated.begin();
    if (!are_possible_lipo_cells(rest_v, cells))
        return {usual, false,
                fmt::format("{}, which would rest at {:.2f} V each: {} are assumed; --cells states the number", states,
                            rest_v / cells, usual)};
    if (cells == usual) return {cells, true};
    return {cells, true,
            fmt::format("{}, which are used; by {:.2f} V at rest they would be {}: --cells states another number",
                        states, rest_v, usual)};
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
    auto curve = common.fitted.aligned.fit;
    auto& errors = common.identification.errors = common.fitted.errors;
    common.end = determined_end(common.fitted);
    cut_curve(curve, errors, common.end.charge_ah);
    common.posterior = capacity_posterior(shown_curve(common.fitted, curve, errors), options.capacity_ah);
    if (common.posterior.empty()) refuse_capacity(common.fitted.aligned, options.capacity_ah.value_or(0.0));
    const auto& [identification, fitted, posterior, end] = common;
    auto& result = common.identification;
    const auto& fit = result.fit = std::move(curve);
    result.cells = fit.weights.cells;
    result.capacity = estimate_capacity(fit.knots_ah.back(), posterior, options.capacity_ah);
    widen_by_end(result.capacity, end);
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
    battery.thevenin =
        TheveninCircuit{extended.curve, fit.rc_resistance_ohm, std::max(min_time_constant_s, fit.rc_time_constant_s)};
    battery.intervals.capacity_ah = result.capacity.interval_ah;
    battery.intervals.open_circuit_standard_error_v = extended.standard_error_v;
    if (fit.rc_resistance_ohm > 0.0) {
        battery.intervals.rc_resistance_ohm = errors.rc_resistance_ohm;
        battery.intervals.rc_time_constant_s = errors.rc_time_constant_s;
    }
    return common;
}

/// Whether the load may have taken more voltage than the charge drawn, so that the flights show no capacity: their
/// resistance may be 0, and at its upper end their mean current takes more than the curve falls.
bool is_charge_hidden(const IdentificationResult& common) {
    const auto& resistance_ohm = common.fitted.errors.resistance_ohm;
    const auto& curve_v = common.identification.fit.open_circuit_v;
    if (resistance_ohm.low > 0.0 || curve_v.empty()) return false;
    double current_a = 0.0;
    for (const auto& aligned : common.fitted.aligned.records) {
        const auto& all_a = aligned.record->current_a;
        const double sum_a = std::accumulate(all_a.begin(), all_a.end(), 0.0);
        current_a = std::max(current_a, sum_a / static_cast<double>(all_a.size()));
    }
    return resistance_ohm.high * current_a > curve_v.front() - curve_v.back();
}

/// The capacity that the flights indicate without a given one; nullptr where they drew too little.
std::shared_ptr<const FlightEstimate> flight_estimate(const IdentificationResult& common) {
    const auto& [identification, fitted, posterior, end] = common;
    const auto& fit = identification.fit;
    if (is_charge_hidden(common)) return nullptr;
    const bool is_given = identification.capacity.origin == CapacityOrigin::given;
    auto estimate = std::make_shared<FlightEstimate>();
    for (const auto& aligned : fitted.aligned.records) estimate->flights.push_back(aligned.record->flight);
    try {
        const auto free =
            is_given ? capacity_posterior(shown_curve(fitted, fit, identification.errors), std::nullopt) : posterior;
        auto capacity = estimate_capacity(fit.knots_ah.back(), free, std::nullopt);
        widen_by_end(capacity, end);
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

double beyond_percent(const BatteryIdentification& identified, const DischargeRecord& record,
                      const std::vector<double>& soc_percent) {
    double beyond = 0.0;
    for (std::size_t i = 0; i < record.time_s.size(); ++i)
        if (record.used[i] && soc_percent[i] < identified.observed_min_soc_percent) beyond += 1.0;
    return units::percentage(beyond, static_cast<double>(used_sample_count(record)));
}

/// How much packs that begin lower differ in what they have relaxed, relative to the prior of the rest offset
/// (circuit_problem.h), which counts as one flight.
double relative_rest_scatter(const JointCircuitFit& aligned) {
    double squares = 1.0;
    double count = 1.0;
    const double charged_sd_v = aligned.fit.weights.cells * charged_rest_sd_v;
    for (const auto& [record, initial_ah, rest_v, own_ohm, log_capacity] : aligned.records) {
        const double sd_v = lower_rest_fraction * (aligned.fit.weights.fullest_rest_v - record->resting_voltage_v);
        if (sd_v <= charged_sd_v) continue;
        squares += std::pow((rest_v - aligned.fit.common_rest_offset_v) / std::hypot(charged_sd_v, sd_v), 2);
        ++count;
    }
    return std::sqrt(squares / count);
}

/// Standard deviation [Ah] of a charge that is inferred from the resting voltage: packs relax differently.
double resting_charge_sd_ah(const DischargeRecord& record, const JointCircuitFit& aligned, double initial_charge_ah) {
    const auto& fit = aligned.fit;
    const double below_v = fit.weights.fullest_rest_v - record.resting_voltage_v;
    const double lower_sd_v = relative_rest_scatter(aligned) * lower_rest_fraction * below_v;
    const double rest_sd_v = std::hypot(fit.weights.cells * charged_rest_sd_v, lower_sd_v, record.resolution_v);
    // The slope of the curve from there on, over a tenth of the charge that it covers.
    const double over_ah = 0.1 * fit.knots_ah.back();
    const double from_ah = std::clamp(initial_charge_ah, 0.0, fit.knots_ah.back() - over_ah);
    const double fall_v = interpolate_clamped(fit.knots_ah, fit.open_circuit_v, from_ah) -
                          interpolate_clamped(fit.knots_ah, fit.open_circuit_v, from_ah + over_ah);
    return std::min(rest_sd_v / std::max(fall_v, unreadable_v) * over_ah, fit.knots_ah.back());
}

/// Checks a record by the battery of other flights, whose power takes the course `others_w`.
LeaveOneOutCheck checked(const IdentificationResult& common, const DischargeRecord& record,
                         const std::vector<double>& others_w) {
    const auto& identified = common.identification;
    const auto& aligned = common.fitted.aligned;
    LeaveOneOutCheck check;
    check.flight = record.flight;
    const double resting_ah = resting_charge_ah(record, aligned);
    check.initial_charge_ah = identified.curve_start_depletion_ah + resting_ah;
    const double charge_sd_ah = resting_charge_sd_ah(record, aligned, resting_ah);
    const double warming_per_j = identified.fit.warming_per_j;
    auto battery = identified.battery;
    const auto modelled_now = [&] {
        const auto [soc, voltage_v] = predict_voltage(battery, record, check.initial_charge_ah, warming_per_j);
        return ModelledRecord{&battery, &record, soc, voltage_v, charge_sd_ah, warming_per_j};
    };
    const auto own = starting_resistance(modelled_now());
    battery.resistance_ohm *= own.value;
    battery.thevenin->rc_resistance_ohm *= own.value;
    const auto modelled = modelled_now();
    const auto after = [&](double since_s) {
        return flight::first_at_or_after(record.time_s, record.time_s[record.rest_samples] + since_s);
    };
    check.voltage_rms_v =
        root_mean_square(errors_v(modelled.voltage_v, record, 0, identified.fit.common_rest_offset_v));
    const auto under_load = errors_v(modelled.voltage_v, record, after(start_s));
    check.load_rms_v = root_mean_square(under_load);
    check.load_mean_error_v = under_load.cwiseAbs().mean();
    double held = 0.0;
    const auto half_v = voltage_half_widths_v(modelled, own);
    for (auto i = after(start_s); i < half_v.size(); ++i) {
        if (!record.used[i]) continue;
        check.load_half_width_v += half_v[i] / static_cast<double>(under_load.size());
        if (std::abs(record.voltage_v[i] - modelled.voltage_v[i]) <= half_v[i]) ++held;
    }
    check.load_held_percent = units::percentage(held, static_cast<double>(under_load.size()));
    const auto ahead = errors_v(predict_voltage_ahead(modelled, looked_ahead_s), record, after(looked_ahead_s));
    check.ahead_error_v = ahead.size() > 0 ? ahead.cwiseAbs().mean() : 0.0;
    if (const auto errors = others_w.empty() ? std::nullopt : forecast_errors(modelled, others_w)) {
        check.forecast_error_v = errors->before_v;
        check.updated_forecast_error_v = errors->updated_v;
    }
    check.extrapolated_percent = beyond_percent(identified, record, modelled.soc_percent);
    return check;
}

}  // namespace

BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options) {
    if (records.empty()) throw NoResultError("no flight is left to identify a battery from");
    const auto& fullest = fullest_of(records);
    if (options.cells) require_possible_cells(fullest.flight, fullest.resting_voltage_v, *options.cells);
    auto cells = choose_cells(records, options);
    auto common = identify_common(fit_circuit_jointly(records, cells.cells), options);
    auto& [result, fitted, posterior, end] = common;
    result.cells_are_given = cells.is_given;
    result.cells_warning = std::move(cells.warning);
    add_health(fitted, options.with_capacities);
    result.errors.initial_charge_error_ah = fitted.errors.initial_charge_error_ah;
    result.errors.resistance_ohm = fitted.errors.resistance_ohm;
    result.battery.intervals.resistance_ohm = fitted.errors.resistance_ohm;
    result.battery.intervals.resistance_scatter = resistance_scatter(fitted.resistances, result.fit.resistance_ohm);
    result.flights = identified_flights(fitted, posterior, result.curve_start_depletion_ah);
    result.battery.flight_estimate = flight_estimate(common);
    std::vector<std::vector<flight::MonitorShare>> monitors;
    monitors.reserve(records.size());
    for (const auto& record : records) monitors.push_back(record.monitors);
    result.battery.monitors = common_monitors(monitors);
    return std::move(result);
}

PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record, double initial_charge_ah,
                                 double warming_per_j) {
    auto warmed = battery;
    const auto& circuit = warmed.thevenin.value();
    const auto settled_a = rc_branch_current_a(record, circuit.rc_time_constant_s);
    PredictedVoltage predicted;
    const auto heat = heat_a2s(record);
    predicted.soc_percent.reserve(record.time_s.size());
    predicted.voltage_v.reserve(record.time_s.size());
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const double drawn_ah = initial_charge_ah + record.charge_ah[i];
        const BatteryState state{units::percent_per_whole - units::percentage(drawn_ah, battery.capacity_ah),
                                 circuit.rc_resistance_ohm * settled_a[i]};
        warmed.resistance_ohm = warmed_resistance_ohm(battery, warming_per_j, heat[i]);
        predicted.soc_percent.push_back(state.soc_percent);
        predicted.voltage_v.push_back(terminal_voltage_v(warmed, state, record.current_a[i]));
    }
    return predicted;
}

std::vector<LeaveOneOutCheck> leave_one_out(std::span<const DischargeRecord> records,
                                            const IdentificationOptions& options,
                                            const std::function<void(std::size_t, std::size_t)>& progress,
                                            std::size_t max_folds) {
    if (records.size() < 2) return {};
    const auto folds = make_folds(records.size(), std::max<std::size_t>(2, max_folds));
    const auto all = fit_circuit_jointly(records, choose_cells(records, options).cells);
    std::vector<LeaveOneOutCheck> checks(records.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    for_each_in_parallel(folds.size(), [&](std::size_t fold) {
        auto common = identify_common(fit_without(all, folds[fold]), options);
        add_health(common.fitted, false);
        auto& battery = common.identification.battery;
        battery.intervals.resistance_scatter = resistance_scatter(common.fitted.resistances, battery.resistance_ohm);
        std::vector<const DischargeRecord*> others;
        for (const auto& aligned : common.fitted.aligned.records) others.push_back(aligned.record);
        const auto others_w = load_power_course_w(others);
        for (const auto k : folds[fold]) checks[k] = checked(common, records[k], others_w);
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(++done, folds.size());
    });
    return checks;
}

}  // namespace flightwatt::battery
