#include "live/state/telemetry_store.h"

#include "base/error.h"
#include "flight/telemetry_series.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
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

bool same_layout(const telemetry::MessageTable& a, const telemetry::MessageTable& b) {
    return std::ranges::equal(a.columns, b.columns, [](const auto& left, const auto& right) {
        return left.field == right.field && left.quantity == right.quantity;
    });
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
    : wanted_(predicting_messages(wanted)) {
    log_.data_file = flight;
    log_.flight = std::move(flight);
    log_.configuration = std::move(configuration);
    if (!log_.configuration) return;
    // It is handed on with every second's lines: without what is not asked for.
    std::erase_if(log_.configuration->messages, [&](const auto& message) {
        return std::ranges::find(wanted_, message.first, &telemetry::MessageRequest::message) == wanted_.end();
    });
    for (auto& aircraft : log_.configuration->aircraft) aircraft.second.block_names.clear();
}

void TelemetryStore::add(std::string_view lines) {
    telemetry::TelemetryLog part;
    try {
        part = telemetry::parse_telemetry(lines, log_.data_file, log_.configuration, wanted_);
    } catch (const InputError&) {
        ++skipped_["seconds with more senders than a network has"];
        return;
    }
    for (const auto& skipped : part.skipped) skipped_[skipped.reason] += skipped.count();
    for (auto& assumed : part.assumed_definitions) {
        const auto is_known = [&](const auto& known) { return known.text == assumed.text; };
        if (std::ranges::none_of(log_.assumed_definitions, is_known) && log_.assumed_definitions.size() < 100)
            log_.assumed_definitions.push_back(std::move(assumed));
    }
    for (auto& sender : part.senders) {
        if (only_ && sender.id != *only_) continue;
        for (auto& table : sender.tables) append(sender.id, std::move(table));
    }
}

telemetry::SenderLog* TelemetryStore::sender_of(const std::string& id) {
    const auto found = std::ranges::find(log_.senders, id, &telemetry::SenderLog::id);
    if (found != log_.senders.end()) return &*found;
    if (log_.senders.size() == max_senders) return nullptr;
    log_.senders.push_back({id, {}});
    return &log_.senders.back();
}

void TelemetryStore::append(const std::string& sender, telemetry::MessageTable&& rows) {
    auto* of = sender_of(sender);
    if (of == nullptr) {
        ++skipped_[fmt::format("of more than {} senders", max_senders)];
        return;
    }
    auto table = std::ranges::find(of->tables, rows.message, &telemetry::MessageTable::message);
    if (table == of->tables.end()) {
        auto empty = rows;
        filter_rows(empty, [](std::size_t) { return false; });
        of->tables.push_back(std::move(empty));
        table = std::prev(of->tables.end());
    }
    if (!same_layout(*table, rows)) {
        skipped_[rows.message + ": another number of fields than before"] += rows.time_s.size();
        return;
    }
    append_rows(*table, rows, thinning_[{sender, rows.message}]);
}

void TelemetryStore::append_rows(telemetry::MessageTable& table, const telemetry::MessageTable& rows,
                                 Thinning& thinning) {
    for (std::size_t row = 0; row < rows.time_s.size(); ++row) {
        auto device = device_of(rows, row);
        if (thinning.rows_of.size() >= max_devices && !thinning.rows_of.contains(device)) {
            ++skipped_[fmt::format("{}: of more than {} devices", rows.message, max_devices)];
            continue;
        }
        if (thinning.rows_of[std::move(device)]++ % thinning.stride != 0) continue;
        table.time_s.push_back(rows.time_s[row]);
        for (std::size_t c = 0; c < table.columns.size(); ++c)
            table.columns[c].values.push_back(rows.columns[c].values[row]);
    }
}

void TelemetryStore::clear() {
    log_.senders.clear();
    log_.assumed_definitions.clear();
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

std::vector<std::string> TelemetryStore::senders() const { return flight::telemetry_senders(log_); }

flight::FlightSeries TelemetryStore::series(const std::string& sender) const {
    return flight::flight_series(log_, sender);
}

std::map<std::string, std::size_t> TelemetryStore::thinned() const {
    std::map<std::string, std::size_t> thinned;
    for (const auto& [name, thinning] : thinning_)
        if (thinning.stride > 1) thinned[name.second] = std::max(thinned[name.second], thinning.stride);
    return thinned;
}

}  // namespace flightwatt::live
