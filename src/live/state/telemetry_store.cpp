#include "live/state/telemetry_store.h"

#include "flight/telemetry_series.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

/// What a flight series is made of, without what no prediction looks at.
std::vector<telemetry::MessageRequest> predicting_messages(const TelemetryFilter& wanted) {
    static const std::set<std::string> of_places{"NAVIGATION", "GPS_LLA"};
    static const std::set<std::string> place_fields{"utm_east", "utm_north", "utm_zone", "lat", "lon"};
    auto messages = flight::flight_messages();
    std::erase_if(messages, [&](const auto& request) {
        const auto& name = request.message;
        return name == "PPRZ_MODE" || name == "TAKEOFF" || (!wanted.bank && name == "ATTITUDE") ||
               (!wanted.places && of_places.contains(name));
    });
    for (auto& request : messages) {
        std::erase_if(request.fields, [&](const auto& field) {
            const bool is_place = place_fields.contains(field) ||
                                  (request.message == "ROTORCRAFT_FP" && (field == "east" || field == "north"));
            return field == "cur_block" || field == "course" || field == "temp" || field == "psi" ||
                   (!wanted.places && is_place);
        });
    }
    return messages;
}

/// Which device a row is of, where several send one message.
std::vector<double> device_of(const telemetry::MessageTable& table, std::size_t row) {
    std::vector<double> device;
    for (const auto* field : {"node_id", "motor_id", "circuit"}) {
        const auto* column = table.column(field);
        if (column != nullptr && std::isfinite(column->values[row])) device.push_back(column->values[row]);
    }
    return device;
}

/// Keeps the rows for which `keep` is true.
void filter_rows(telemetry::MessageTable& table, const std::function<bool(std::size_t)>& keep) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        if (!keep(row)) continue;
        table.time_s[kept] = table.time_s[row];
        for (auto& column : table.columns) column.values[kept] = column.values[row];
        ++kept;
    }
    table.time_s.resize(kept);
    for (auto& column : table.columns) column.values.resize(kept);
}

}  // namespace

TelemetryStore::TelemetryStore(std::string flight, std::optional<telemetry::LogConfiguration> configuration,
                               TelemetryFilter wanted)
    : decoder_(configuration, predicting_messages(wanted)) {
    log_.data_file = flight;
    log_.flight = std::move(flight);
    log_.configuration = std::move(configuration);
    if (!log_.configuration) return;
    log_.configuration->messages.clear();  // its decoder has them
    for (auto& aircraft : log_.configuration->aircraft) aircraft.second.block_names.clear();
}

void TelemetryStore::add(double time_s, std::string_view message, std::span<const double> values) {
    const auto sender = message.substr(0, message.find(' '));
    message.remove_prefix(std::min(sender.size() + 1, message.size()));
    const auto* row = decoder_.decode(time_s, message, values);
    if (row != nullptr && (!only_ || sender == *only_)) append(std::string(sender), *row);
}

void TelemetryStore::append(const std::string& sender, const telemetry::MessageTable& row) {
    auto of = std::ranges::find(log_.senders, sender, &telemetry::SenderLog::id);
    if (of == log_.senders.end()) {
        if (log_.senders.size() == max_senders)
            return void(++not_kept_[fmt::format("of more than {} senders", max_senders)]);
        of = log_.senders.insert(of, {sender, {}});
    }
    auto& thinning = thinning_[{sender, row.message}];
    auto device = device_of(row, 0);
    if (thinning.rows_of.size() >= max_devices && !thinning.rows_of.contains(device))
        return void(++not_kept_[fmt::format("{}: of more than {} devices", row.message, max_devices)]);
    auto table = std::ranges::find(of->tables, row.message, &telemetry::MessageTable::message);
    if (table == of->tables.end()) {
        table = of->tables.insert(table, row);
        filter_rows(*table, [](std::size_t) { return false; });
    }
    if (thinning.rows_of[std::move(device)]++ % thinning.stride != 0) return;
    table->time_s.push_back(row.time_s.front());
    for (std::size_t c = 0; c < table->columns.size(); ++c)
        table->columns[c].values.push_back(row.columns[c].values.front());
}

void TelemetryStore::clear() {
    log_.senders.clear();
    decoder_.restart();
    thinning_.clear();
}

void TelemetryStore::drop_before(double time_s) {
    for (auto& sender : log_.senders)
        for (auto& table : sender.tables)
            filter_rows(table, [&](std::size_t row) { return table.time_s[row] >= time_s; });
    for (auto& sender : log_.senders)
        std::erase_if(sender.tables, [](const telemetry::MessageTable& table) { return table.empty(); });
}

void TelemetryStore::drop(const std::string& sender) {
    std::erase_if(log_.senders, [&](const telemetry::SenderLog& log) { return log.id == sender; });
    std::erase_if(thinning_, [&](const auto& of) { return of.first.first == sender; });
}

void TelemetryStore::keep_only(const std::string& sender) {
    only_ = sender;
    std::erase_if(log_.senders, [&](const telemetry::SenderLog& log) { return log.id != sender; });
    std::erase_if(thinning_, [&](const auto& of) { return of.first.first != sender; });
}

void TelemetryStore::thin() {
    telemetry::MessageTable* most = nullptr;
    const std::string* sender_id = nullptr;
    for (auto& sender : log_.senders) {
        for (auto& table : sender.tables) {
            if (most != nullptr && table.time_s.size() <= most->time_s.size()) continue;
            most = &table;
            sender_id = &sender.id;
        }
    }
    if (most == nullptr) return;
    auto& thinning = thinning_[{*sender_id, most->message}];
    thinning.stride *= 2;
    std::map<std::vector<double>, std::size_t> rows_of;
    filter_rows(*most, [&](std::size_t row) { return rows_of[device_of(*most, row)]++ % 2 == 0; });
}

std::size_t TelemetryStore::rows() const {
    std::size_t rows = 0;
    for (const auto& sender : log_.senders)
        for (const auto& table : sender.tables) rows += table.time_s.size();
    return rows;
}

std::map<std::string, std::size_t> TelemetryStore::skipped() const {
    auto skipped = not_kept_;
    skipped.insert(decoder_.skipped().begin(), decoder_.skipped().end());
    return skipped;
}

std::vector<std::string> TelemetryStore::senders() const { return flight::telemetry_senders(log_); }

flight::FlightSeries TelemetryStore::series(const std::string& sender) const {
    auto series = flight::flight_series(log_, sender);
    series.assumed_definitions = decoder_.assumed_definitions();
    return series;
}

std::map<std::string, std::size_t> TelemetryStore::thinned() const {
    std::map<std::string, std::size_t> thinned;
    for (const auto& [name, thinning] : thinning_)
        if (thinning.stride > 1) thinned[name.second] = std::max(thinned[name.second], thinning.stride);
    return thinned;
}

}  // namespace flightwatt::live
