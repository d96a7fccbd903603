#include "battery/battery.h"

#include "base/piecewise_linear.h"
#include "base/text.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double min_time_constant_s = 0.1;
constexpr double max_time_constant_s = 1e5;
constexpr double max_number = 1e6;  // squared and divided, values below stay numbers
constexpr int max_cells = 100;

OpenCircuitVoltage read_curve(const TomlTable& table) {
    OpenCircuitVoltage curve{table.numbers("soc_percent"), table.numbers("voltage_v")};
    const auto& soc = curve.soc_percent;
    const auto& volts = curve.voltage_v;
    const auto refuse = [&](std::string_view key, const std::string& message, const std::string& hint) {
        throw InputError(table.where(key), message, hint);
    };
    if (soc.size() < 2 || soc.front() != 0.0 || soc.back() != 100.0 ||
        std::ranges::adjacent_find(soc, std::greater_equal<>()) != soc.end())
        refuse("soc_percent", "soc_percent does not rise from 0 to 100", "expected [0, ..., 100]");
    if (volts.size() != soc.size()) {
        refuse("voltage_v", fmt::format("{} voltages for {} states of charge", volts.size(), soc.size()),
               "expected one each");
    }
    if (volts.front() <= 0.0 || std::ranges::adjacent_find(volts, std::greater<>()) != volts.end()) {
        refuse("voltage_v", "the open-circuit voltage is not positive, or falls as charge rises",
               "expected values in the order of soc_percent, none below the one before");
    }
    return curve;
}

std::vector<double> read_curve_errors(const TomlTable& table, std::size_t knots) {
    if (!table.has("standard_error_v")) return {};
    auto errors = table.numbers("standard_error_v");
    if (errors.size() != knots || std::ranges::any_of(errors, [](double e) { return e < 0; })) {
        throw InputError(table.where("standard_error_v"),
                         "standard_error_v: expected one number of at least 0 for every knot");
    }
    return errors;
}

TheveninCircuit read_circuit(const TomlTable& table, BatteryIntervals& intervals) {
    TheveninCircuit circuit;
    const auto curve = table.table("open_circuit");
    circuit.open_circuit = read_curve(curve);
    intervals.open_circuit_standard_error_v = read_curve_errors(curve, circuit.open_circuit.soc_percent.size());
    curve.refuse_unknown_keys();
    if (table.has("rc_resistance_ohm"))
        circuit.rc_resistance_ohm = number_in(at_least(0.0), table, "rc_resistance_ohm");
    if (circuit.rc_resistance_ohm > 0.0 || table.has("rc_time_constant_s")) {
        circuit.rc_time_constant_s = number_in(between(min_time_constant_s, max_time_constant_s), table,
                                               "rc_time_constant_s", "a faster RC pair is part of resistance_ohm");
    }
    return circuit;
}

/// The interval of a key, which has to hold the value.
Interval read_interval(const TomlTable& table, std::string_view key, double value) {
    const auto ends = table.numbers(key);
    if (ends.size() != 2 || !(ends[0] <= value && value <= ends[1])) {
        throw InputError(table.where(key), fmt::format("the interval does not contain {} = {}", key, value),
                         "expected [LOW, HIGH]");
    }
    return {ends[0], ends[1]};
}

std::optional<Interval> optional_interval(const TomlTable& table, std::string_view key, double value) {
    if (!table.has(key)) return std::nullopt;
    return read_interval(table, key, value);
}

FlightEstimate read_estimate(const TomlTable& table) {
    FlightEstimate estimate;
    estimate.capacity_ah = number_in(more_than(0.0), table, "capacity_ah");
    estimate.capacity_interval_ah = read_interval(table, "capacity_interval_ah", estimate.capacity_ah);
    if (table.has("flights")) estimate.flights = table.strings("flights");
    if (table.has("soc_percent") || table.has("voltage_v")) estimate.open_circuit = read_curve(table);
    table.refuse_unknown_keys();
    return estimate;
}

void read_intervals(const TomlTable& table, Battery& battery) {
    auto& intervals = battery.intervals;
    intervals.capacity_ah = optional_interval(table, "capacity_ah", battery.capacity_ah);
    intervals.resistance_ohm = optional_interval(table, "resistance_ohm", battery.resistance_ohm);
    if (battery.thevenin) {
        const auto& circuit = *battery.thevenin;
        intervals.rc_resistance_ohm = optional_interval(table, "rc_resistance_ohm", circuit.rc_resistance_ohm);
        intervals.rc_time_constant_s = optional_interval(table, "rc_time_constant_s", circuit.rc_time_constant_s);
    } else {
        intervals.voltage_v = optional_interval(table, "voltage_v", battery.voltage_v);
    }
    table.refuse_unknown_keys();
}

void read_between_flights(const TomlTable& table, BatteryIntervals& intervals) {
    intervals.resistance_scatter = ResistanceScatter{number_in(at_least(0.0), table, "resistance_sd_ohm"),
                                                     static_cast<std::size_t>(count_in(table, "flights", 2))};
    table.refuse_unknown_keys();
}

std::string between_flights_lines(const std::optional<ResistanceScatter>& scatter) {
    if (!scatter) return "";
    return fmt::format("\n# variability between flights\n[between_flights]\nflights = {}\nresistance_sd_ohm = {}\n",
                       scatter->flights, toml_real(scatter->sd_ohm));
}

std::string interval_lines(const BatteryIntervals& intervals) {
    std::string lines;
    for (const auto& [key, interval] : {std::pair{"capacity_ah", intervals.capacity_ah},
                                        {"voltage_v", intervals.voltage_v},
                                        {"resistance_ohm", intervals.resistance_ohm},
                                        {"rc_resistance_ohm", intervals.rc_resistance_ohm},
                                        {"rc_time_constant_s", intervals.rc_time_constant_s}})
        if (interval) lines += fmt::format("{} = {}\n", key, toml_reals({interval->low, interval->high}));
    return lines.empty() ? "" : "\n# 95 %\n[intervals]\n" + lines;
}

std::string curve_lines(const OpenCircuitVoltage& curve) {
    return fmt::format("soc_percent = {}\nvoltage_v = {}\n", toml_reals(curve.soc_percent),
                       toml_reals(curve.voltage_v));
}

std::string estimate_lines(const FlightEstimate& estimate) {
    const auto& [low, high] = estimate.capacity_interval_ah;
    auto lines = fmt::format(
        "\n# The capacity that the flights indicate, and the curve over it\n[flight_estimate]\n"
        "capacity_ah = {}\ncapacity_interval_ah = {}\n",
        toml_real(estimate.capacity_ah), toml_reals({low, high}));
    if (!estimate.flights.empty()) lines += fmt::format("flights = {}\n", toml_strings(estimate.flights));
    return estimate.open_circuit.soc_percent.empty() ? lines : lines + curve_lines(estimate.open_circuit);
}

double limit_at_w(const Battery& battery, double voltage_v) {
    if (voltage_v <= 0.0) return 0.0;
    if (battery.resistance_ohm == 0.0) return std::numeric_limits<double>::infinity();
    return voltage_v * voltage_v / (4.0 * battery.resistance_ohm);
}

/// The current at a voltage before the resistor, of a power that is not beyond the limit.
double current_at_a(const Battery& battery, double voltage_v, double power_w) {
    if (power_w == 0.0) return 0.0;
    const double u = std::max(0.0, voltage_v);
    // (U - sqrt(D)) / (2 R), multiplied out: no difference of near numbers, no division by R. At the limit
    // rounding may leave D a hair below zero.
    const double discriminant = std::max(0.0, u * u - 4.0 * battery.resistance_ohm * power_w);
    return 2.0 * power_w / (u + std::sqrt(discriminant));
}

}  // namespace

double full_energy_wh(const Battery& battery) {
    if (!battery.thevenin) return battery.capacity_ah * battery.voltage_v;
    const auto& [knots, voltage_v] = battery.thevenin->open_circuit;
    double integral = 0.0;  // [V points]
    for (std::size_t k = 1; k < knots.size(); ++k)
        integral += (knots[k] - knots[k - 1]) * (voltage_v[k - 1] + voltage_v[k]) / 2.0;
    return battery.capacity_ah * integral / (knots.back() - knots.front());
}

double open_circuit_voltage_v(const Battery& battery, double soc_percent) {
    if (!battery.thevenin) return battery.voltage_v;
    const auto& curve = battery.thevenin->open_circuit;
    return interpolate_clamped(curve.soc_percent, curve.voltage_v, soc_percent);
}

double source_voltage_v(const Battery& battery, const BatteryState& state) {
    return open_circuit_voltage_v(battery, state.soc_percent) - state.rc_voltage_v;
}

double terminal_voltage_v(const Battery& battery, const BatteryState& state, double current_a) {
    return source_voltage_v(battery, state) - battery.resistance_ohm * current_a;
}

double power_limit_w(const Battery& battery, const BatteryState& state) {
    return limit_at_w(battery, source_voltage_v(battery, state));
}

double internal_current_a(const Battery& battery, double power_w, const BatteryState& state) {
    const double limit_w = power_limit_w(battery, state);
    if (power_w > limit_w) {
        throw NoResultError(
            fmt::format("the battery cannot deliver {} W: its limit U^2 / (4 R) is {} W", power_w, limit_w));
    }
    return current_at_a(battery, source_voltage_v(battery, state), power_w);
}

double limited_current_a(const Battery& battery, double power_w, const BatteryState& state) {
    const double voltage_v = source_voltage_v(battery, state);
    return current_at_a(battery, voltage_v, std::min(power_w, limit_at_w(battery, voltage_v)));
}

Battery battery_from(const TomlTable& table) {
    Battery battery;
    battery.name = table.optional_string("name").value_or("");
    const auto model = table.optional_string("model").value_or("paper");
    if (model != "paper" && model != "thevenin") {
        throw InputError(table.where("model"), fmt::format("there is no battery model '{}'", model),
                         "it is \"paper\" or \"thevenin\"");
    }
    if (model == "paper") battery.voltage_v = number_in(more_than_up_to(0.0, max_number), table, "voltage_v");
    battery.resistance_ohm = number_in(at_least(0.0), table, "resistance_ohm");
    battery.capacity_ah = number_in(more_than_up_to(0.0, max_capacity_ah), table, "capacity_ah", capacity_hint);
    if (table.has("cells")) {
        const auto cells = count_in(table, "cells");
        require_in(between(1.0, max_cells), static_cast<double>(cells), "cells", table.where("cells"));
        battery.cells = static_cast<int>(cells);
    }
    if (model == "thevenin") {
        battery.thevenin = read_circuit(table, battery.intervals);
        if (const auto estimate = table.optional_table("flight_estimate"))
            battery.flight_estimate = std::make_shared<FlightEstimate>(read_estimate(*estimate));
    }
    if (const auto intervals = table.optional_table("intervals")) read_intervals(*intervals, battery);
    if (const auto between = table.optional_table("between_flights")) read_between_flights(*between, battery.intervals);
    table.refuse_unknown_keys();
    return battery;
}

Battery read_battery(const std::filesystem::path& path) {
    const auto root = read_toml(path, FileKind::battery);
    require_known_format(root);
    return battery_from(root);
}

std::optional<Battery> estimated_by_flights(const Battery& battery) {
    if (!battery.flight_estimate) return std::nullopt;
    const auto& [capacity_ah, interval_ah, flights, open_circuit] = *battery.flight_estimate;
    if (interval_ah.low <= battery.capacity_ah && battery.capacity_ah <= interval_ah.high) return std::nullopt;
    auto estimated = battery;
    estimated.capacity_ah = capacity_ah;
    estimated.intervals.capacity_ah = interval_ah;
    if (!open_circuit.soc_percent.empty()) {
        estimated.thevenin.value().open_circuit = open_circuit;
        estimated.intervals.open_circuit_standard_error_v.clear();  // those are of the other curve's knots
    }
    return estimated;
}

std::string capacity_warning(const Battery& battery) {
    if (!estimated_by_flights(battery)) return "";
    const auto& [low, high] = battery.flight_estimate->capacity_interval_ah;
    return fmt::format(
        "the capacity of {:.4g} Ah contradicts the flights, which indicate {:.3g} Ah ({:.3g} to {:.3g} Ah in 95 %): "
        "check the pack's label, or give no capacity to use the estimate of the flights",
        battery.capacity_ah, battery.flight_estimate->capacity_ah, low, high);
}

std::vector<std::string> battery_warnings(const Battery& battery) {
    constexpr double min_v = 2.5;
    constexpr double max_v = 60.0;
    constexpr double min_ah = 0.05;
    constexpr double min_limit_w = 1.0;
    std::vector<std::string> warnings;
    const auto full_v = open_circuit_voltage_v(battery, units::percent_per_whole);
    if (full_v < min_v || full_v > max_v) {
        warnings.push_back(fmt::format("battery: {:.4g} V when full is {}: check that the unit is V", full_v,
                                       full_v < min_v ? "less than one cell's" : "more than 14 LiPo cells'"));
    }
    if (battery.capacity_ah < min_ah) {
        warnings.push_back(fmt::format("battery: {:.4g} Ah is too small for a drone's pack: check that the unit is Ah",
                                       battery.capacity_ah));
    }
    if (const auto warning = capacity_warning(battery); !warning.empty()) warnings.push_back("battery: " + warning);
    if (const double limit_w = power_limit_w(battery); limit_w < min_limit_w) {
        warnings.push_back(
            fmt::format("battery: it cannot deliver more than {:.3g} W: check that resistance_ohm is in ohm", limit_w));
    }
    return warnings;
}

std::string to_toml(const Battery& battery) {
    std::string text = format_line() + fmt::format("name = {}\n", toml_string(battery.name));
    text += fmt::format("model = \"{}\"\n", battery.thevenin ? "thevenin" : "paper");
    if (!battery.thevenin) text += fmt::format("voltage_v = {}\n", toml_real(battery.voltage_v));
    text += fmt::format("capacity_ah = {}\nresistance_ohm = {}\n", toml_real(battery.capacity_ah),
                        toml_real(battery.resistance_ohm));
    if (battery.cells) text += fmt::format("cells = {}\n", *battery.cells);
    if (battery.thevenin) {
        const auto& circuit = *battery.thevenin;
        text += fmt::format("rc_resistance_ohm = {}\n", toml_real(circuit.rc_resistance_ohm));
        if (circuit.rc_resistance_ohm > 0.0)
            text += fmt::format("rc_time_constant_s = {}\n", toml_real(circuit.rc_time_constant_s));
        text += "\n[open_circuit]\n" + curve_lines(circuit.open_circuit);
        const auto& errors = battery.intervals.open_circuit_standard_error_v;
        if (!errors.empty()) text += fmt::format("standard_error_v = {}\n", toml_reals(errors));
        if (battery.flight_estimate) text += estimate_lines(*battery.flight_estimate);
    }
    return text + interval_lines(battery.intervals) + between_flights_lines(battery.intervals.resistance_scatter);
}

}  // namespace flightwatt::battery
