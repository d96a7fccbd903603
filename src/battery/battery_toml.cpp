#include "battery/battery_toml.h"

#include "base/error.h"
#include "base/toml_fields.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double max_number = 1e6;  // squared and divided, values below stay numbers
constexpr int max_cells = 100;
constexpr int max_monitors = 100;

void require_curve(const TomlTable& table, const OpenCircuitVoltage& curve) {
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
}

void list_curve(TomlFields& fields, OpenCircuitVoltage& curve) {
    fields.reals("soc_percent", curve.soc_percent);
    fields.reals("voltage_v", curve.voltage_v);
    if (fields.source() != nullptr) require_curve(*fields.source(), curve);
}

void list_open_circuit(TomlFields& fields, Battery& battery) {
    auto& curve = battery.thevenin->open_circuit;
    auto& errors_v = battery.intervals.open_circuit_standard_error_v;
    list_curve(fields, curve);
    if (!fields.has("standard_error_v", !errors_v.empty())) return;
    fields.reals("standard_error_v", errors_v);
    const bool fits = errors_v.size() == curve.soc_percent.size() &&
                      std::ranges::all_of(errors_v, [](double error_v) { return error_v >= 0.0; });
    if (fields.source() != nullptr && !fits)
        throw InputError(fields.source()->where("standard_error_v"),
                         "standard_error_v: expected one number of at least 0 for every knot");
}

/// Lists the interval of a key, which has to contain the value.
void list_interval(TomlFields& fields, std::string_view key, Interval& interval, double value) {
    std::vector<double> ends{interval.low, interval.high};
    fields.reals(key, ends);
    if (fields.source() == nullptr) return;
    if (ends.size() != 2 || !(ends[0] <= value && value <= ends[1]))
        throw InputError(fields.source()->where(key), fmt::format("the interval does not contain {} = {}", key, value),
                         "expected [LOW, HIGH]");
    interval = {ends[0], ends[1]};
}

void list_optional_interval(TomlFields& fields, std::string_view key, std::optional<Interval>& interval, double value) {
    if (fields.has(key, interval.has_value()))
        list_interval(fields, key, interval ? *interval : interval.emplace(), value);
}

void list_intervals(TomlFields& fields, Battery& battery) {
    auto& intervals = battery.intervals;
    list_optional_interval(fields, "capacity_ah", intervals.capacity_ah, battery.capacity_ah);
    if (!battery.thevenin) list_optional_interval(fields, "voltage_v", intervals.voltage_v, battery.voltage_v);
    list_optional_interval(fields, "resistance_ohm", intervals.resistance_ohm, battery.resistance_ohm);
    if (!battery.thevenin) return;
    const auto& circuit = *battery.thevenin;
    list_optional_interval(fields, "rc_resistance_ohm", intervals.rc_resistance_ohm, circuit.rc_resistance_ohm);
    list_optional_interval(fields, "rc_time_constant_s", intervals.rc_time_constant_s, circuit.rc_time_constant_s);
}

bool has_interval(const BatteryIntervals& intervals) {
    return intervals.capacity_ah || intervals.voltage_v || intervals.resistance_ohm || intervals.rc_resistance_ohm ||
           intervals.rc_time_constant_s;
}

void list_scatter(TomlFields& fields, ResistanceScatter& scatter) {
    fields.count("flights", scatter.flights, 2);
    fields.real("resistance_sd_ohm", scatter.sd_ohm, at_least(0.0));
}

void list_estimate(TomlFields& fields, FlightEstimate& estimate) {
    fields.real("capacity_ah", estimate.capacity_ah, more_than(0.0));
    list_interval(fields, "capacity_interval_ah", estimate.capacity_interval_ah, estimate.capacity_ah);
    if (fields.has("flights", !estimate.flights.empty())) fields.texts("flights", estimate.flights);
    const bool has_curve = !estimate.open_circuit.soc_percent.empty();
    if (fields.has("soc_percent", has_curve) || fields.has("voltage_v", has_curve))
        list_curve(fields, estimate.open_circuit);
}

void list_thevenin(TomlFields& fields, Battery& battery) {
    auto& circuit = *battery.thevenin;
    if (fields.has("rc_resistance_ohm", true))
        fields.real("rc_resistance_ohm", circuit.rc_resistance_ohm, at_least(0.0));
    if (circuit.rc_resistance_ohm > 0.0 || fields.has("rc_time_constant_s", false))
        fields.real("rc_time_constant_s", circuit.rc_time_constant_s, between(min_time_constant_s, max_time_constant_s),
                    "a faster RC pair is part of resistance_ohm");
    fields.line("");
    fields.table("open_circuit", battery, list_open_circuit, TomlLayout::section);
    auto& shared = battery.flight_estimate;
    if (!fields.has("flight_estimate", shared != nullptr)) return;
    auto estimate = shared ? *shared : FlightEstimate{};
    fields.line("\n# The capacity that the flights indicate, and the curve over it");
    fields.table("flight_estimate", estimate, list_estimate, TomlLayout::section);
    shared = std::make_shared<const FlightEstimate>(std::move(estimate));
}

/// Lists the name of the circuit, by which the battery has a Thévenin circuit or none.
void list_circuit_name(TomlFields& fields, Battery& battery) {
    std::string model = battery.thevenin ? "thevenin" : "paper";
    if (!fields.has("model", true)) return;
    fields.text("model", model);
    if (fields.source() == nullptr) return;
    if (model != "paper" && model != "thevenin")
        throw InputError(fields.source()->where("model"), fmt::format("there is no battery model '{}'", model),
                         "it is \"paper\" or \"thevenin\"");
    if (model == "thevenin") battery.thevenin.emplace();
}

void list_cells(TomlFields& fields, std::optional<int>& cells) {
    if (!fields.has("cells", cells.has_value())) return;
    auto count = static_cast<std::size_t>(cells.value_or(0));
    fields.count("cells", count);
    if (const auto* table = fields.source())
        require_in(between(1.0, max_cells), static_cast<double>(count), "cells", table->where("cells"));
    cells = static_cast<int>(count);
}

/// Lists the battery monitors, and the parts of the charge that they count, if known [%].
void list_monitors(TomlFields& fields, std::vector<flight::MonitorShare>& monitors) {
    if (!fields.has("monitors", !monitors.empty())) return;
    const auto* table = fields.source();
    const auto numbers = table == nullptr ? std::vector<double>{} : table->numbers("monitors");
    constexpr double written_steps = 1000.0;  // of a percent
    std::vector<std::size_t> written;
    std::vector<double> percent;
    for (const auto& [number, part] : monitors) {
        written.push_back(static_cast<std::size_t>(number));
        if (part > 0.0) percent.push_back(std::round(part * units::percent_per_whole * written_steps) / written_steps);
    }
    if (table == nullptr) fields.counts("monitors", written);
    if (fields.has("monitor_percent", !percent.empty())) fields.reals("monitor_percent", percent);
    if (table == nullptr) return;
    for (const double number : numbers)
        if (!(number >= 1.0 && number <= max_monitors && number == std::floor(number)))
            throw InputError(table->where("monitors"), fmt::format("monitors: {:g} is no number of one", number),
                             "expected BATT: 1, BATT2: 2 ...");
    const bool are_parts = percent.size() == numbers.size() &&
                           std::ranges::all_of(percent, [](double part) { return part > 0.0; }) &&
                           std::abs(std::accumulate(percent.begin(), percent.end(), 0.0) - 100.0) <= 1.0;
    if (!percent.empty() && !are_parts)
        throw InputError(table->where("monitor_percent"), "monitor_percent does not divide 100 % among the monitors",
                         "expected one number above 0 for each");
    for (std::size_t i = 0; i < numbers.size(); ++i)
        monitors.push_back(
            {static_cast<int>(numbers[i]), percent.empty() ? 0.0 : percent[i] / units::percent_per_whole});
}

void list_battery(TomlFields& fields, Battery& battery) {
    if (fields.has("name", true)) fields.text("name", battery.name);
    list_circuit_name(fields, battery);
    if (!battery.thevenin) fields.real("voltage_v", battery.voltage_v, more_than_up_to(0.0, max_number));
    fields.real("capacity_ah", battery.capacity_ah, more_than_up_to(0.0, max_capacity_ah), capacity_hint);
    fields.real("resistance_ohm", battery.resistance_ohm, at_least(0.0));
    list_cells(fields, battery.cells);
    list_monitors(fields, battery.monitors);
    if (battery.thevenin) list_thevenin(fields, battery);
    if (fields.has("intervals", has_interval(battery.intervals))) {
        fields.line("\n# 95 %");
        fields.table("intervals", battery, list_intervals, TomlLayout::section);
    }
    if (battery.intervals.resistance_scatter) fields.line("\n# variability between flights");
    fields.optional_table("between_flights", battery.intervals.resistance_scatter, list_scatter, TomlLayout::section);
}

}  // namespace

Battery read_battery(const std::filesystem::path& path) {
    const auto root = read_toml(path, FileKind::battery);
    require_known_format(root);
    return battery_from(root);
}

Battery battery_from(const TomlTable& table) {
    Battery battery;
    TomlFields fields(table);
    list_battery(fields, battery);
    table.refuse_unknown_keys();
    return battery;
}

std::string to_toml(const Battery& battery) {
    auto listed = battery;
    TomlFields fields("");
    list_battery(fields, listed);
    return format_line() + fields.lines() + "\n";
}

}  // namespace flightwatt::battery
