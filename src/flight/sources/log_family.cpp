#include "flight/sources/log_family.h"

#include "flight/sources/derived_tracks.h"
#include "flight/telemetry_series.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

using telemetry::Column;
using telemetry::MessageTable;

/// Tracks of which each battery has its own.
bool is_of_battery(std::string_view track) {
    constexpr std::string_view names[] = {"voltage_v", "current_a", "power_w", "charge_ah", "energy_wh"};
    return std::ranges::find(names, track) != std::end(names);
}

void append_row(MessageTable& to, const MessageTable& from, std::size_t row) {
    to.time_s.push_back(from.time_s[row]);
    for (std::size_t c = 0; c < from.columns.size(); ++c) to.columns[c].values.push_back(from.columns[c].values[row]);
}

/// Splits a table by instance, without rows that do not count.
void split(const MessageTable& table, const LogFamily& family, std::vector<InstanceTable>& tables) {
    constexpr std::size_t max_instances = 16;
    const Column* instance = nullptr;
    const Column* valid = nullptr;
    double min_valid = 0.0;
    for (const auto& rule : family.messages) {
        if (table.message != rule.message) continue;
        if (instance == nullptr && rule.instance != nullptr) instance = table.column(rule.instance);
        if (rule.valid == nullptr) continue;
        valid = table.column(rule.valid);
        min_valid = rule.min_valid;
    }
    std::map<double, MessageTable> by_instance;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        const double number = instance == nullptr ? 0.0 : instance->values[row];
        if (std::isnan(number) || (valid != nullptr && !(valid->values[row] >= min_valid))) continue;
        auto found = by_instance.find(number);
        if (found == by_instance.end()) {
            if (by_instance.size() == max_instances) continue;
            MessageTable empty{table.message, {}, table.columns};
            for (auto& column : empty.columns) column.values.clear();
            found = by_instance.emplace(number, std::move(empty)).first;
        }
        append_row(found->second, table, row);
    }
    for (auto& [number, of] : by_instance)
        tables.push_back({std::move(of), instance == nullptr ? "" : fmt::format("{}", number)});
}

/// The values of a field in the unit of its track; empty if the log has another quantity or type there.
std::vector<double> values_of(const MessageTable& table, const FamilyField& field) {
    const auto* column = table.column(field.field);
    if (column == nullptr) return {};
    using Stored = FamilyField::Stored;
    if (field.stored != Stored::any && column->is_integer != (field.stored == Stored::integer)) return {};
    const auto unit = units::parse_unit(field.unit);
    if (unit && column->quantity && column->quantity != unit->quantity) return {};
    const double factor = !unit ? 1.0 : column->quantity ? std::copysign(1.0, unit->factor) : unit->factor;
    std::vector<double> values(column->values.size());
    std::ranges::transform(column->values, values.begin(), [&](double value) {
        return value == field.absent ? std::numeric_limits<double>::quiet_NaN() : value * factor;
    });
    return values;
}

/// "BAT.Volt"; of the second and further instances "BARO[1].Alt".
std::string source_of(const InstanceTable& of, const char* field) {
    const bool is_further = !of.instance.empty() && of.instance != "0";
    return fmt::format("{}{}.{}", of.table.message, is_further ? fmt::format("[{}]", of.instance) : "", field);
}

void add_candidate(std::vector<Track>& tracks, const InstanceTable& of, const FamilyField& field,
                   const std::string& source, const std::vector<double>& values) {
    if (values.empty()) return;
    add_track(tracks, field.track, source, of.table, values, field.merge);
    if (is_of_battery(field.track)) tracks.back().device = of.instance;
}

std::vector<Track> family_tracks(const FamilyLog& log, const LogFamily& family) {
    std::vector<Track> tracks;
    for (const auto& field : family.fields)
        for (const auto& of : log.tables)
            if (of.table.message == field.message)
                add_candidate(tracks, of, field,
                              is_of_battery(field.track) ? fmt::format("{}.{}", field.message, field.field)
                                                         : source_of(of, field.field),
                              values_of(of.table, field));
    for (std::size_t i = 0; i + 1 < family.power.size(); i += 2) {
        const auto& voltage = family.power[i];
        const auto& current = family.power[i + 1];
        for (const auto& of : log.tables) {
            if (of.table.message != voltage.message) continue;
            auto values = values_of(of.table, voltage);
            const auto current_a = values_of(of.table, current);
            if (values.empty() || current_a.empty()) continue;
            std::ranges::transform(values, current_a, values.begin(), std::multiplies<>());
            add_candidate(tracks, of, {"power_w", voltage.message, voltage.field, "W"},
                          fmt::format("{0}.{1} * {0}.{2}", voltage.message, voltage.field, current.field), values);
        }
    }
    family.add(log, tracks);
    const auto& names = track_names();
    std::ranges::stable_sort(tracks, {},
                             [&](const Track& track) { return std::ranges::find(names, track.name) - names.begin(); });
    return tracks;
}

/// The assumed units of battery fields for which the log states none.
void note_units(const FamilyLog& log, const LogFamily& family, FlightSeries& series) {
    std::set<std::string> assumed;
    for (const auto& field : family.power) {
        for (const auto& of : log.tables) {
            const auto* column = of.table.message == field.message ? of.table.column(field.field) : nullptr;
            if (column != nullptr && !column->quantity && !values_of(of.table, field).empty())
                assumed.insert(fmt::format("{}.{} is read in {}", field.message, field.field, field.unit));
        }
    }
    if (family.notes_units && !assumed.empty())
        series.notes.push_back(fmt::format("the log states no units: {}", fmt::join(assumed, ", ")));
}

}  // namespace

const MessageTable* FamilyLog::table(std::string_view message) const {
    const auto found = std::ranges::find_if(
        tables, [&](const InstanceTable& of) { return of.table.message == message && !of.table.empty(); });
    return found == tables.end() ? nullptr : &found->table;
}

void add_track(std::vector<Track>& tracks, const char* name, const std::string& source, const MessageTable& table,
               const std::vector<double>& values, Merge merge) {
    tracks.push_back(make_candidate(name, source, table, values, merge));
}

FlightSeries family_series(telemetry::AutopilotLog read, const LogFamily& family) {
    FlightSeries series;
    auto& log = read.log;
    series.file = log.data_file.string();
    series.flight = log.flight;
    series.skipped = std::move(log.skipped);
    series.current_origin = CurrentOrigin::sensor;
    FamilyLog split_log{{}, read.facts};
    for (const auto& sender : log.senders) {
        series.clock_restart = find_clock_restart(sender);
        for (const auto& table : sender.tables) split(table, family, split_log.tables);
    }
    series.tracks = family_tracks(split_log, family);
    family.describe(split_log, series);
    note_units(split_log, family, series);
    if (read.facts.dropouts > 0)
        series.notes.push_back(fmt::format("the logger lost data {} times, for {:.1f} s in all", read.facts.dropouts,
                                           read.facts.dropout_s));
    return series;
}

std::vector<telemetry::MessageRequest> family_messages(const LogFamily& family) {
    std::vector<telemetry::MessageRequest> requests;
    const auto add = [&](const char* message, const char* field) {
        if (field == nullptr) return;
        auto found = std::ranges::find(requests, message, &telemetry::MessageRequest::message);
        if (found == requests.end()) found = requests.insert(found, {message, {}});
        if (std::ranges::find(found->fields, field) == found->fields.end()) found->fields.emplace_back(field);
    };
    for (const auto& field : family.fields) add(field.message, field.field);
    for (const auto& more : family.more)
        for (const auto& field : more.fields) add(more.message.c_str(), field.c_str());
    for (const auto& rule : family.messages) {
        add(rule.message, rule.instance);
        add(rule.message, rule.valid);
    }
    return requests;
}

}  // namespace flightwatt::flight
