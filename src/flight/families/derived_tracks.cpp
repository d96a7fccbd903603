#include "flight/families/derived_tracks.h"

#include "base/units.h"
#include "flight/select/device_sum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <GeographicLib/TransverseMercator.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

using telemetry::Column;
using telemetry::MessageTable;
using telemetry::SenderLog;
using units::Quantity;

/// The column with the given quantity, or nullptr.
const Column* column_of(const MessageTable& table, const char* field, Quantity quantity) {
    const auto* column = table.column(field);
    return column != nullptr && column->quantity == quantity ? column : nullptr;
}

std::vector<double> products(const Column& a, const Column& b) {
    std::vector<double> result(a.values.size());
    std::transform(a.values.begin(), a.values.end(), b.values.begin(), result.begin(), std::multiplies<>());
    return result;
}

/// A message that several devices send, identified by the values of its id fields.
struct DeviceMessage {
    const MessageTable& table;
    std::vector<const Column*> ids;
};

/// Adds the rows of one device. The second, third ... report of one time get tracks of their own and are not merged.
void add_device(std::vector<Track>& tracks, const std::string& id, const Track& as, const MessageTable& table,
                const std::vector<std::pair<double, double>>& rows) {
    std::vector<MessageTable> reports;
    std::vector<std::vector<double>> values;
    double last_s = no_value;
    std::size_t report = 0;
    for (const auto& [time_s, value] : rows) {
        report = time_s == last_s ? report + 1 : 0;
        last_s = time_s;
        if (report == reports.size()) {
            reports.push_back({table.message, {}, {}});
            values.emplace_back();
        }
        reports[report].time_s.push_back(time_s);
        values[report].push_back(value);
    }
    for (std::size_t r = 0; r < reports.size(); ++r) {
        tracks.push_back(make_candidate(as.name, as.source, reports[r], values[r], Merge::mean));
        tracks.back().device = r == 0 ? id : fmt::format("{}{}{}", id, report_separator, r + 1);
    }
}

void add_devices(std::vector<Track>& tracks, const DeviceMessage& message, const char* name, const std::string& source,
                 const std::vector<double>& column_values) {
    std::map<std::vector<double>, std::vector<std::pair<double, double>>> rows;
    for (std::size_t i = 0; i < column_values.size(); ++i) {
        std::vector<double> id;
        for (const auto* column : message.ids) id.push_back(column->values[i]);
        if (std::any_of(id.begin(), id.end(), [](double part) { return std::isnan(part); })) continue;
        rows[id].emplace_back(message.table.time_s[i], column_values[i]);
    }
    for (auto& [id, of_device] : rows) {
        std::ranges::stable_sort(of_device, {}, &std::pair<double, double>::first);
        const auto text = id.empty() ? std::string("all") : fmt::format("{}", fmt::join(id, "/"));
        add_device(tracks, text, {.name = name, .source = source}, message.table, of_device);
    }
}

void add_device_message(std::vector<Track>& tracks, const MessageTable* table,
                        std::initializer_list<const char*> id_fields, const char* voltage_field,
                        const char* current_field) {
    if (table == nullptr) return;
    DeviceMessage message{*table, {}};
    for (const auto* field : id_fields)
        if (const auto* column = table->column(field)) message.ids.push_back(column);
    const auto* voltage = column_of(*table, voltage_field, Quantity::volt);
    const auto* current = column_of(*table, current_field, Quantity::ampere);
    if (const auto* power = column_of(*table, "power", Quantity::watt)) {
        add_devices(tracks, message, "power_w", table->message, power->values);
    } else if (voltage != nullptr && current != nullptr) {
        add_devices(tracks, message, "power_w", table->message, products(*voltage, *current));
    }
    if (current == nullptr) return;
    add_devices(tracks, message, "current_a", fmt::format("{}.{}", table->message, current->field), current->values);
}

}  // namespace

std::pair<double, double> position_from_utm(const std::vector<double>& east_north_zone) {
    const double east_m = east_north_zone[0];
    const double north_m = east_north_zone[1];
    const double zone = east_north_zone[2];
    if (!(zone >= 1.0 && zone <= 60.0) || !std::isfinite(east_m) || !std::isfinite(north_m))
        return {no_value, no_value};
    constexpr double false_east_m = 500e3;
    constexpr double degree_per_zone = 6.0;
    constexpr double first_meridian_deg = -183.0;
    std::pair<double, double> position;
    GeographicLib::TransverseMercator::UTM().Reverse(first_meridian_deg + degree_per_zone * zone, east_m - false_east_m,
                                                     north_m, position.first, position.second);
    return position;
}

Track make_candidate(const std::string& name, const std::string& source, const MessageTable& table,
                     const std::vector<double>& values, Merge merge) {
    auto track = make_track(table.time_s, values, merge);
    track.name = name;
    track.source = source;
    const bool is_whole = track.time_s.size() == table.time_s.size();  // in the order of time
    track.since_s = is_whole ? track.time_s.front() : *std::ranges::min_element(table.time_s);
    return track;
}

void add_derived_tracks(std::vector<Track>& tracks, const SenderLog& sender) {
    if (const auto* takeoff = sender.table("TAKEOFF"); takeoff != nullptr && !takeoff->empty()) {
        std::vector<double> ones(takeoff->time_s.size(), 1.0);
        tracks.push_back(make_candidate("takeoff", "TAKEOFF", *takeoff, ones, Merge::latest));
    }
    add_device_message(tracks, sender.table("ESC"), {"node_id", "motor_id"}, "bat_volts", "amps");
    add_device_message(tracks, sender.table("POWER_DEVICE"), {"node_id", "circuit"}, "voltage", "current");
}

}  // namespace flightwatt::flight
