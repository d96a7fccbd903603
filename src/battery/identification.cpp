#include "battery/identification.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::battery {
namespace {

constexpr int most_segments = 12;
constexpr double least_sample_part = 20.0;  // samples a segment, at least
constexpr double unreadable_v = 0.01;       // smaller differences between resting voltages are none
constexpr int alignments = 5;

std::vector<double> equal_knots(std::span<const AlignedRecord> records, int segments) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto& [record, initial] : records) {
        const auto [least, most] = std::ranges::minmax_element(record->charge_ah);
        low = std::min(low, *least + initial);
        high = std::max(high, *most + initial);
    }
    low = std::max(low, 0.0);
    std::vector<double> knots;
    for (int i = 0; i <= segments; ++i) knots.push_back(std::lerp(low, high, static_cast<double>(i) / segments));
    return knots;
}

bool falls_throughout(const CircuitFit& fit) {
    return std::ranges::adjacent_find(fit.open_circuit_v, std::less<>()) == fit.open_circuit_v.end();
}

/// As many independent samples as neighbours' correlation leaves of the residuals.
double effective_samples(const Eigen::VectorXd& residual) {
    const auto n = residual.size();
    const double alike = residual.head(n - 1).dot(residual.tail(n - 1)) / residual.squaredNorm();
    const double r = std::clamp(alike, 0.0, 0.99);
    return static_cast<double>(n) * (1.0 - r) / (1.0 + r);
}

/// Akaike's: a stiffer curve predicts as well, but leans the resistances towards its misfit.
double criterion(const CircuitFit& fit, double samples) {
    const auto parameters = static_cast<double>(fit.knots_ah.size()) + 3.0;
    return samples * std::log(fit.rms_v * fit.rms_v + 1e-18) + 2.0 * parameters;
}

/// The fit with the number of segments that the data support.
CircuitFit best_fit(std::span<const AlignedRecord> records) {
    std::vector<CircuitFit> fits;
    double samples = 0.0;
    for (int segments = 1; segments <= most_segments; ++segments) {
        auto fit = fit_circuit(records, equal_knots(records, segments));
        if (static_cast<double>(fit.residual_v.size()) < least_sample_part * segments) break;
        samples = effective_samples(fit.residual_v);  // the last has least of the curve's misfit left
        if (falls_throughout(fit)) fits.push_back(std::move(fit));
    }
    if (fits.empty()) throw NoAnswerError("the open-circuit voltage does not fall as charge is drawn");
    return *std::ranges::min_element(fits, {}, [&](const CircuitFit& fit) { return criterion(fit, samples); });
}

/// The charge at which the fitted curve, which falls, has this voltage; 0 to the last knot.
double charge_at_voltage_ah(const CircuitFit& fit, double voltage_v) {
    const std::vector<double> rising_v(fit.open_circuit_v.rbegin(), fit.open_circuit_v.rend());
    const std::vector<double> charge_ah(fit.knots_ah.rbegin(), fit.knots_ah.rend());
    return interpolate_clamped(rising_v, charge_ah, voltage_v);
}

/// The open-circuit voltage [V] that a record begins with: at rest, less what the electronics take.
double initial_voltage_v(const DischargeRecord& record, double resistance_ohm) {
    return record.resting_voltage_v + resistance_ohm * record.resting_current_a;
}

struct AlignedFit {
    std::vector<AlignedRecord> records;
    CircuitFit fit;
};

/// Lays every record onto the curve of `fit` by its resting voltage; returns the greatest move [Ah].
double align(std::vector<AlignedRecord>& records, const CircuitFit& fit) {
    const double resistance_ohm = fit.resistance_ohm + fit.rc_resistance_ohm;
    double highest_v = 0.0;
    for (const auto& aligned : records)
        highest_v = std::max(highest_v, initial_voltage_v(*aligned.record, resistance_ohm));
    double moved_ah = 0.0;
    for (auto& [record, initial_ah] : records) {
        const double below_v = highest_v - initial_voltage_v(*record, resistance_ohm);
        double now_ah = 0.0;
        if (below_v > std::max(unreadable_v, record->resolution_v))
            now_ah = charge_at_voltage_ah(fit, fit.open_circuit_v.front() - below_v);
        moved_ah = std::max(moved_ah, std::abs(now_ah - initial_ah));
        initial_ah = now_ah;
    }
    return moved_ah;
}

/// The curve and the initial charges that belong to it: begun with the fullest flight's own curve.
AlignedFit aligned_fit(std::span<const DischargeRecord> records) {
    AlignedFit aligned;
    for (const auto& record : records) aligned.records.push_back({&record, 0.0});
    const auto fullest = *std::ranges::max_element(
        aligned.records, {}, [](const auto& aligned_record) { return aligned_record.record->resting_voltage_v; });
    aligned.fit = best_fit({&fullest, 1});
    for (int i = 0; i < alignments; ++i) {
        const double moved_ah = align(aligned.records, aligned.fit);
        if (i > 0 && moved_ah < 1e-3 * aligned.fit.knots_ah.back()) break;
        aligned.fit = best_fit(aligned.records);
    }
    return aligned;
}

/// The state of charge at which the open-circuit voltage is that which the record begins with.
double initial_soc_percent(const Battery& battery, const DischargeRecord& record) {
    const auto& circuit = battery.thevenin.value();
    const auto& [soc, volts] = circuit.open_circuit;
    const double initial_v = initial_voltage_v(record, battery.resistance_ohm + circuit.rc_resistance_ohm);
    if (initial_v >= volts.back() - std::max(unreadable_v, record.resolution_v)) return soc.back();
    return interpolate_clamped(volts, soc, initial_v);
}

std::vector<IdentifiedFlight> identified_flights(const AlignedFit& aligned) {
    std::vector<IdentifiedFlight> flights;
    Eigen::Index row = 0;
    for (const auto& [record, initial_ah] : aligned.records) {
        IdentifiedFlight flight;
        flight.flight = record->flight;
        flight.resting_voltage_v = record->resting_voltage_v;
        flight.initial_charge_ah = initial_ah;
        flight.drawn_ah = record->charge_ah.back();
        const auto used = used_samples(*record);
        flight.samples = static_cast<std::size_t>(used);
        flight.unused = record->used.size() - flight.samples;
        flight.voltage_rms_v =
            std::sqrt(aligned.fit.residual_v.segment(row, used).squaredNorm() / static_cast<double>(used));
        row += used;
        flights.push_back(std::move(flight));
    }
    return flights;
}

}  // namespace

BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options) {
    if (records.empty()) throw NoAnswerError("no flight is left to identify a battery from");
    const auto aligned = aligned_fit(records);
    BatteryIdentification result;
    result.fit = aligned.fit;
    result.errors = circuit_errors(aligned.records, aligned.fit);
    result.flights = identified_flights(aligned);
    const double highest_v =
        std::ranges::max_element(records, {}, &DischargeRecord::resting_voltage_v)->resting_voltage_v;
    result.cells = options.cells.value_or(lipo_cells(highest_v));
    result.capacity =
        capacity_of(aligned.fit, result.errors.open_circuit_standard_error_v.back(), result.cells, options.capacity_ah);
    const auto extended = extended_curve(aligned.fit, result.errors.open_circuit_standard_error_v,
                                         result.capacity.value_ah, result.cells);
    result.known_down_to_percent = extended.known_down_to_percent;

    auto& battery = result.battery;
    battery.name = options.name;
    battery.resistance_ohm = aligned.fit.resistance_ohm;
    battery.capacity_ah = result.capacity.value_ah;
    battery.thevenin =
        TheveninCircuit{extended.curve, aligned.fit.rc_resistance_ohm, std::max(0.1, aligned.fit.rc_time_constant_s)};
    battery.intervals.capacity_ah = result.capacity.interval_ah;
    battery.intervals.resistance_ohm = result.errors.resistance_ohm;
    battery.intervals.open_circuit_standard_error_v = extended.standard_error_v;
    if (aligned.fit.rc_resistance_ohm > 0.0) {
        battery.intervals.rc_resistance_ohm = result.errors.rc_resistance_ohm;
        battery.intervals.rc_time_constant_s = result.errors.rc_time_constant_s;
    }
    return result;
}

PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record) {
    const auto& circuit = battery.thevenin.value();
    const double initial_percent = initial_soc_percent(battery, record);
    const auto settled_a = settled_current_a(record, circuit.rc_time_constant_s);
    PredictedVoltage predicted;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        const BatteryState state{initial_percent - units::percent_of(record.charge_ah[i], battery.capacity_ah),
                                 circuit.rc_resistance_ohm * settled_a[i]};
        predicted.soc_percent.push_back(state.soc_percent);
        predicted.voltage_v.push_back(terminal_voltage_v(battery, state, record.current_a[i]));
    }
    return predicted;
}

std::vector<LeftOutCheck> leave_each_out(std::span<const DischargeRecord> records,
                                         const IdentificationOptions& options) {
    std::vector<LeftOutCheck> checks;
    if (records.size() < 2) return checks;
    for (std::size_t k = 0; k < records.size(); ++k) {
        std::vector<DischargeRecord> others(records.begin(), records.end());
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        const auto identified = identify_battery(others, options);
        const auto& record = records[k];
        const auto predicted = predict_voltage(identified.battery, record);
        const auto samples = static_cast<double>(used_samples(record));
        double squares = 0.0;
        double beyond = 0.0;
        for (std::size_t i = 0; i < record.time_s.size(); ++i) {
            if (!record.used[i]) continue;
            squares += std::pow(record.voltage_v[i] - predicted.voltage_v[i], 2);
            if (predicted.soc_percent[i] < identified.known_down_to_percent) beyond += 1.0;
        }
        checks.push_back({record.flight, std::sqrt(squares / samples), units::percent_of(beyond, samples)});
    }
    return checks;
}

}  // namespace flightwatt::battery
