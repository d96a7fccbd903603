#include "exchange/message_table.h"

#include "base/csv.h"
#include "base/error.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"
#include "telemetry/log_reader.h"
#include "telemetry/message_definition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::exchange {
namespace {

std::string_view suffix_of(units::Quantity quantity) {
    constexpr std::array<std::string_view, 12> suffixes{"_v",       "_a", "_w",       "_ah",  "_wh", "_m",
                                                        "_m_per_s", "_s", "_percent", "_deg", "_c",  "_kg"};
    return suffixes.at(static_cast<std::size_t>(quantity));
}

/// The fields of a message in the order of the .log; without a .log, those of all known layouts.
std::vector<std::string> fields_of(const std::optional<telemetry::LogConfiguration>& configuration,
                                   const std::string& message) {
    std::vector<telemetry::MessageDefinition> layouts;
    if (!configuration) {
        layouts = telemetry::builtin_definitions(message);
        std::ranges::stable_sort(layouts, std::greater<>(), [](const auto& layout) { return layout.fields.size(); });
    } else if (const auto found = configuration->messages.find(message); found != configuration->messages.end()) {
        layouts.push_back(found->second);
    }
    std::vector<std::string> fields;
    for (const auto& layout : layouts)
        for (const auto& field : layout.fields)
            if (std::ranges::find(fields, field.name) == fields.end()) fields.push_back(field.name);
    return fields;
}

telemetry::TelemetryLog read_message(const flight::FlightFile& file,
                                     std::optional<telemetry::LogConfiguration> configuration,
                                     const telemetry::MessageRequest& message) {
    auto wanted = flight::flight_messages();  // they show the recordings
    std::erase_if(wanted, [&](const telemetry::MessageRequest& other) { return other.message == message.message; });
    wanted.push_back(message);
    if (!file.framing()) return parse_telemetry(file.text(), file.path(), std::move(configuration), wanted);
    return flight::with_binary_log(file, [&](const telemetry::BinaryLog& log) {
        return parse_binary_telemetry(log, std::move(configuration).value(), wanted);
    });
}

[[noreturn]] void refuse_absent(const flight::FlightFile& file, const std::string& message, bool is_defined) {
    const auto names = flight::list_message_counts(file);
    const auto is_it = [&](const std::string& name) { return name.starts_with(message + " "); };
    if (!is_defined && std::ranges::any_of(names, is_it))
        throw InputError({file.path().string()}, fmt::format("has no definition of {}", message),
                         "add the .log of the log, or give --messages FILE");
    throw InputError({file.path().string()}, fmt::format("contains no readable {}", message),
                     "it contains " + short_list(names));
}

/// The rows of a message of one sender. Throws InputError without any, or for several senders.
const telemetry::MessageTable& table_of(const telemetry::TelemetryLog& log, const flight::FlightFile& file,
                                        const std::string& message, const std::optional<std::string>& sender) {
    std::vector<std::string> ids;
    const telemetry::MessageTable* chosen = nullptr;
    for (const auto& candidate : log.senders) {
        const auto* table = candidate.table(message);
        if (table == nullptr || table->empty()) continue;
        ids.push_back(candidate.id);
        if (!sender || candidate.id == *sender) chosen = table;
    }
    if (ids.empty()) refuse_absent(file, message, true);
    if (chosen == nullptr) {
        throw InputError({log.data_file.string()}, fmt::format("aircraft {} sent no {}", *sender, message),
                         "it was sent by " + short_list(ids));
    }
    if (!sender && ids.size() > 1) {
        throw InputError({log.data_file.string()},
                         fmt::format("{} senders sent {}: {}", ids.size(), message, short_list(ids)),
                         "choose one with --aircraft ID");
    }
    return *chosen;
}

/// A number with all its digits, if converted without rounding errors of the conversion.
std::string cell(double value, bool is_converted) {
    if (!std::isfinite(value)) return {};
    return is_converted ? fmt::format("{:.15g}", value) : fmt::format("{}", value);
}

MessageCsv as_csv(const telemetry::MessageTable& table) {
    MessageCsv result;
    std::vector<const telemetry::Column*> columns;
    std::vector<std::string> header{"time_s"};
    for (const auto& column : table.columns) {
        if (std::ranges::none_of(column.values, [](double value) { return std::isfinite(value); })) {
            result.left_out.push_back(column.field);
            continue;
        }
        columns.push_back(&column);
        auto name = column.field;
        if (column.quantity && !name.ends_with(suffix_of(*column.quantity))) name += suffix_of(*column.quantity);
        header.push_back(csv_cell(name));
    }
    result.csv = fmt::format("{}\n", fmt::join(header, ","));
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        result.csv += cell(table.time_s[row], false);
        for (const auto* column : columns) result.csv += "," + cell(column->values[row], column->quantity.has_value());
        result.csv += '\n';
    }
    return result;
}

/// Adds the rows of a sender to those of the same id, of an aircraft that flew before, or as another sender.
void add_sender(telemetry::SenderLog sender, std::vector<telemetry::SenderLog>& senders) {
    const auto known = std::ranges::find(senders, sender.id, &telemetry::SenderLog::id);
    if (known == senders.end()) return senders.push_back(std::move(sender));
    for (auto& table : sender.tables) {
        const auto same = std::ranges::find(known->tables, table.message, &telemetry::MessageTable::message);
        if (same == known->tables.end()) {
            known->tables.push_back(std::move(table));
            continue;
        }
        const auto append = [](auto& values, const auto& more) {
            values.insert(values.end(), more.begin(), more.end());
        };
        append(same->time_s, table.time_s);
        append(same->places, table.places);
        for (std::size_t i = 0; i < std::min(same->columns.size(), table.columns.size()); ++i)
            append(same->columns[i].values, table.columns[i].values);
    }
}

/// The log of another autopilot with that message of each aircraft, and the times of all others, which show the
/// recordings.
telemetry::TelemetryLog read_autopilot_message(const flight::FlightFile& file, const std::string& message) {
    const auto read = [&](const std::vector<telemetry::MessageRequest>& wanted) {
        return read_autopilot_logs(file.text(), file.autopilot().value(), file.path(), wanted);
    };
    std::vector<telemetry::MessageRequest> wanted;
    for (auto& log : read({}))
        for (auto& [name, count, fields] : log.messages)
            if (std::ranges::find(wanted, name, &telemetry::MessageRequest::message) == wanted.end())
                wanted.push_back({name, name == message ? std::move(fields) : std::vector<std::string>()});
    auto logs = read(wanted);
    for (std::size_t i = 1; i < logs.size(); ++i)
        for (auto& sender : logs[i].log.senders) add_sender(std::move(sender), logs.front().log.senders);
    return std::move(logs.front().log);
}

telemetry::TelemetryLog read_message_of(const flight::FlightFile& file, const std::string& message) {
    if (file.autopilot()) return read_autopilot_message(file, message);
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto& text = file.log_text()) configuration = telemetry::parse_log_configuration(*text, file.log_file());
    const auto fields = fields_of(configuration, message);
    if (fields.empty()) refuse_absent(file, message, false);
    return read_message(file, std::move(configuration), {message, fields});
}

/// The sender that --aircraft names: the only one of an autopilot's log by any name, of several in a .tlog that with
/// the number, which may follow a name ("ArduCopter 2").
std::optional<std::string> named_sender(const flight::FlightFile& file, const telemetry::TelemetryLog& log,
                                        const std::optional<std::string>& aircraft) {
    if (!aircraft || !file.autopilot()) return aircraft;
    return log.senders.size() < 2 ? std::nullopt : std::optional(aircraft->substr(aircraft->rfind(' ') + 1));
}

}  // namespace

MessageCsv message_table(const flight::FlightFile& file, const std::string& message,
                         const std::optional<std::string>& sender, std::size_t recording) {
    if (file.is_series()) {
        throw InputError({file.path().string()}, "is a series, which contains tracks and no messages",
                         "give the log that it was made from, or remove --message");
    }
    const auto recordings = flight::recordings_of(read_message_of(file, message));
    if (recording > recordings.size()) {
        throw InputError({file.path().string()},
                         fmt::format("has no recording {}: there are {}", recording, recordings.size()));
    }
    const auto& log = recordings[recording - 1];
    auto table = as_csv(table_of(log, file, message, named_sender(file, log, sender)));
    table.recordings = recordings.size();
    return table;
}

std::string series_table(const flight::FlightSeries& series) {
    auto text = to_csv(series);
    std::size_t start = 0;
    while (start < text.size() && text[start] == '#') start = text.find('\n', start) + 1;
    return text.substr(start);
}

}  // namespace flightwatt::exchange
