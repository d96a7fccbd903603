#include "flight/sources/device_tracks.h"

#include "flight/track.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

using telemetry::Column;
using telemetry::MessageTable;

/// The first of `fields` that the table has with the given quantity; nullptr if it has none.
const Column* first_column(const MessageTable& table, std::initializer_list<const char*> fields,
                           units::Quantity quantity) {
    for (const auto* field : fields) {
        const auto* column = table.column(field);
        if (column != nullptr && column->quantity == quantity) return column;
    }
    return nullptr;
}

/// One track for each different id; the ids are the values of the id fields that the message has.
void add_tracks(std::vector<Track>& tracks, const MessageTable& table,
                std::initializer_list<const char*> id_fields, const char* name, const std::string& source,
                const std::vector<double>& column_values) {
    std::map<std::vector<double>, std::pair<std::vector<double>, std::vector<double>>> rows;
    for (std::size_t i = 0; i < column_values.size(); ++i) {
        std::vector<double> id;
        for (const auto* field : id_fields) {
            if (const auto* column = table.column(field)) id.push_back(column->values[i]);
        }
        if (std::any_of(id.begin(), id.end(), [](double part) { return part != part; })) continue;
        auto& [times, values] = rows[id];
        times.push_back(table.time_s[i]);
        values.push_back(column_values[i]);
    }
    for (const auto& [id, row] : rows) {
        auto track = make_track(row.first, row.second, Merge::mean);
        track.name = name;
        track.source = source;
        track.device = id.empty() ? "all" : fmt::format("{}", fmt::join(id, "/"));
        track.since_s = *std::min_element(row.first.begin(), row.first.end());
        tracks.push_back(std::move(track));
    }
}

void add_message(std::vector<Track>& tracks, const MessageTable* table,
                 std::initializer_list<const char*> id_fields) {
    if (table == nullptr) return;
    const auto [voltage, current] = voltage_and_current(*table);
    const auto* power = first_column(*table, {"power"}, units::Quantity::watt);
    if (power != nullptr) {
        add_tracks(tracks, *table, id_fields, "power_w", table->message, power->values);
    } else if (voltage != nullptr && current != nullptr) {
        add_tracks(tracks, *table, id_fields, "power_w", table->message,
                   products(voltage->values, current->values));
    }
    if (current != nullptr) {
        add_tracks(tracks, *table, id_fields, "current_a",
                   fmt::format("{}.{}", table->message, current->field), current->values);
    }
}

}  // namespace

VoltageAndCurrent voltage_and_current(const MessageTable& table) {
    return {first_column(table, {"voltage", "bat", "bat_volts"}, units::Quantity::volt),
            first_column(table, {"current", "amp", "amps"}, units::Quantity::ampere)};
}

std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

void add_device_tracks(std::vector<Track>& tracks, const telemetry::SenderLog& sender) {
    add_message(tracks, sender.table("ESC"), {"node_id", "motor_id"});
    add_message(tracks, sender.table("POWER_DEVICE"), {"node_id", "circuit"});
}

}  // namespace flightwatt::flight
