#include "telemetry/autopilot/row_collector.h"

#include "base/error.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::telemetry {
namespace {

constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();
constexpr double after_last_s = std::numeric_limits<double>::infinity();

bool continues_clock(double time_s, double from_s) {
    constexpr double max_back_s = 1.0;  // messages are written in almost the order of their times
    constexpr double max_ahead_s = 10.0;
    return time_s >= from_s - max_back_s && time_s <= from_s + max_ahead_s;
}

bool is_whole(const LoggedField& field) {
    using enum WireType;
    return field.factor == 1.0 && field.type != float32 && field.type != float64 && field.type != text;
}

}  // namespace

double LoggedField::number(std::string_view bytes) const {
    if (type == WireType::text || offset + size_of(type) > bytes.size()) return unknown_value;
    const double value = wire_value(type, bytes.data() + offset);
    return std::isfinite(value) ? value * factor : unknown_value;
}

std::optional<std::size_t> LoggedMessage::index_of(std::string_view field) const {
    const auto found = std::ranges::find(fields, field, &LoggedField::name);
    return found == fields.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - fields.begin()));
}

RowCollector::RowCollector(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted) : file_(file) {
    for (const auto& [message, fields] : wanted) {
        auto& table = sender_.tables.emplace_back(MessageTable{message, {}, {}});
        for (const auto& field : fields) table.columns.push_back({field, std::nullopt, {}});
        is_bound_.emplace_back(fields.size(), false);
    }
}

void RowCollector::bind(LoggedMessage& message) {
    auto& tables = sender_.tables;
    const auto found = std::ranges::find(tables, message.name, &MessageTable::message);
    message.column_fields.clear();
    message.table.reset();
    if (found == tables.end()) return;
    message.table = static_cast<std::size_t>(found - tables.begin());
    for (std::size_t i = 0; i < found->columns.size(); ++i) {
        const auto field = message.index_of(found->columns[i].field);
        message.column_fields.push_back(field);
        if (!field) continue;
        is_bound_[*message.table][i] = true;
        found->columns[i].is_integer = is_whole(message.fields[*field]);
    }
}

void RowCollector::append(const Row& row) {
    auto& table = sender_.tables[row.table];
    table.time_s.push_back(row.time_s);
    table.places.push_back(row.offset + 1);
    for (std::size_t i = 0; i < table.columns.size(); ++i) table.columns[i].values.push_back(row.values[i]);
}

void RowCollector::drop(const std::optional<Row>& row) {
    if (row) skips_.add({SkipReason::no_time, 0}, std::isnan(last_s_) ? row->time_s : last_s_, row->offset + 1);
}

void RowCollector::count_gap(double time_s) {
    if (gap_ > 0) skips_.add({SkipReason::damage, 0}, time_s, gap_offset_ + 1, gap_);
    gap_ = 0;
}

void RowCollector::add(const LoggedMessage& message, double time_s, std::size_t offset, const ValueOf& value_of) {
    if (!message.table) return;
    if (std::isnan(time_s)) {
        if (std::isnan(last_s_)) ++untimed_;  // events before the first time
        if (!std::isnan(last_s_)) skips_.add({SkipReason::no_time, 0}, last_s_, offset + 1);
        return;
    }
    Row row{*message.table, time_s, offset, {}};
    for (const auto& field : message.column_fields) row.values.push_back(field ? value_of(*field) : unknown_value);
    if (continues_clock(time_s, last_s_)) {
        drop(pending_);
    } else if (pending_ && continues_clock(time_s, pending_->time_s)) {
        append(*pending_);
    } else {  // also at the beginning
        drop(pending_);
        pending_ = std::move(row);
        return;
    }
    pending_.reset();
    count_gap(time_s);
    last_s_ = time_s;
    append(row);
}

void RowCollector::skip(std::size_t offset, std::size_t count) {
    constexpr std::size_t max_skipped = 64'000'000;
    if (count == 0) return;
    if (gap_ == 0) gap_offset_ = offset;
    gap_ += count;
    skipped_ += count;
    if (skipped_ > max_skipped)
        throw InputError({file_.string()}, "has more than 64 MB that are no messages",
                         "is it a whole log of an autopilot?");
}

void RowCollector::list(const LoggedMessage& message) {
    if (message.count == 0) return;
    auto& listed = result_.messages.emplace_back(AutopilotMessage{message.name, message.count, {}});
    for (const auto& field : message.fields) listed.fields.push_back(field.name);
}

std::vector<MessageTable>& RowCollector::end() {
    if (pending_ && std::isnan(last_s_))
        append(*pending_);
    else
        drop(pending_);
    pending_.reset();
    return sender_.tables;
}

AutopilotLog RowCollector::take(bool as_lines) {
    auto& tables = end();
    count_gap(after_last_s);
    for (std::size_t t = 0; t < tables.size(); ++t) {
        std::size_t column = 0;
        std::erase_if(tables[t].columns, [&](const Column&) { return !is_bound_[t][column++]; });
    }
    std::erase_if(tables, [](const MessageTable& table) { return table.empty(); });
    if (tables.empty() && untimed_ > 0) skips_.add({SkipReason::no_time, 0}, after_last_s, 1, untimed_);
    auto& log = result_.log;
    log.data_file = file_;
    log.flight = flight_name(file_);
    for (auto& [kind, skipped] : skips_.take()) {
        const bool is_row = kind.reason == SkipReason::no_time;
        skipped.reason = is_row     ? "messages whose time is damaged, or that have none"
                         : as_lines ? "no message"
                                    : "damaged or cut off";
        using Unit = SkippedLines::Unit;
        skipped.unit = as_lines ? Unit::line : is_row ? Unit::frame : Unit::byte;
        log.skipped.push_back(std::move(skipped));
    }
    log.senders.push_back(std::move(sender_));
    return std::move(result_);
}

}  // namespace flightwatt::telemetry
