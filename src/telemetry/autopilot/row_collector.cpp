#include "telemetry/autopilot/row_collector.h"

#include "base/error.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();
constexpr double after_last_s = std::numeric_limits<double>::infinity();

constexpr double max_ahead_s = 10.0;
constexpr std::size_t damaged_time = 0;  // details of SkipReason::no_time
constexpr std::size_t without_time = 1;

bool continues_clock(double time_s, double from_s) {
    constexpr double max_back_s = 1.0;  // messages are written in almost the order of their times
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
    if (!row.table) return;
    auto& table = sender_.tables[*row.table];
    table.time_s.push_back(row.time_s);
    table.places.push_back(row.offset + 1);
    for (std::size_t i = 0; i < table.columns.size(); ++i) table.columns[i].values.push_back(row.values[i]);
}

/// The row's time is right.
void RowCollector::set_time(const Row& row) {
    constexpr std::size_t few = 10;  // events of the start
    if (std::isnan(last_s_) && early_ > few)
        skips_.add({SkipReason::no_time, without_time}, row.time_s, first_early_ + 1, early_);
    place_untimed(row.time_s);
    count_gap(row.time_s);
    last_s_ = row.time_s;
    append(row);
}

/// The pending row's time is damaged; rows behind it belong to the time before.
void RowCollector::drop_pending() {
    if (!pending_) return;
    skips_.add({SkipReason::no_time, damaged_time}, std::isnan(last_s_) ? pending_->time_s : last_s_,
               pending_->offset + 1);
    if (!std::isnan(last_s_)) std::ranges::move(behind_pending_, std::back_inserter(untimed_));
    if (std::isnan(last_s_)) early_ += behind_pending_.size();
    behind_pending_.clear();
    pending_.reset();
}

/// Appends the rows without a time: evenly up to the next time, if they are about as many as usual in that time, else
/// at the usual interval. Of those after the last time only the first ten seconds count.
void RowCollector::place_untimed(double next_s) {
    constexpr double pause_intervals = 3.0;
    const auto intervals = static_cast<double>(untimed_.size() + 1);
    const double ahead_s = std::max(next_s - last_s_, 0.0);
    const double usual_s = intervals_ > 0.0 ? timed_s_ / intervals_ : 0.0;
    const double pause_s = intervals_ > 0.0 ? pause_intervals * usual_s * intervals : max_ahead_s;
    const double step_s = ahead_s > pause_s ? usual_s : ahead_s / intervals;
    const double end_s = std::isfinite(next_s) ? next_s : last_s_ + max_ahead_s;
    double time_s = last_s_;
    for (auto& row : untimed_) {
        time_s += step_s;
        row.time_s = std::min(time_s, std::max(end_s, last_s_));
        if (std::isfinite(next_s) || time_s <= end_s)
            append(row);
        else
            skips_.add({SkipReason::no_time, without_time}, last_s_, row.offset + 1);
    }
    untimed_.clear();
    if (!(ahead_s <= max_ahead_s)) return;
    timed_s_ += ahead_s;
    intervals_ += intervals;
}

void RowCollector::count_gap(double time_s) {
    if (gap_ > 0) skips_.add({SkipReason::damage, 0}, time_s, gap_offset_ + 1, gap_);
    gap_ = 0;
}

void RowCollector::add(const LoggedMessage& message, std::optional<double> time_s, std::size_t offset,
                       const ValueOf& value_of) {
    has_times_ = has_times_ || time_s;
    if (!message.table && !message.is_clock) return;
    const bool is_damaged = time_s && std::isnan(*time_s);
    if (std::isnan(last_s_) && (is_damaged || (!time_s && !pending_))) {
        if (early_++ == 0) first_early_ = offset;
        return;
    }
    if (is_damaged) return skips_.add({SkipReason::no_time, damaged_time}, last_s_, offset + 1);
    Row row{message.table, time_s.value_or(last_s_), offset, {}};
    for (const auto& field : message.column_fields) row.values.push_back(field ? value_of(*field) : unknown_value);
    if (!time_s) return (pending_ ? behind_pending_ : untimed_).push_back(std::move(row));
    if (continues_clock(*time_s, last_s_)) {
        drop_pending();
    } else if (pending_ && continues_clock(*time_s, pending_->time_s)) {
        set_time(*std::exchange(pending_, std::nullopt));
        untimed_ = std::exchange(behind_pending_, {});
    } else {  // also at the beginning
        drop_pending();
        pending_ = std::move(row);
        return;
    }
    set_time(row);
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

void RowCollector::end() {
    if (pending_ && std::isnan(last_s_)) {
        set_time(*std::exchange(pending_, std::nullopt));
        untimed_ = std::exchange(behind_pending_, {});
    }
    drop_pending();
    if (!std::isnan(last_s_)) place_untimed(after_last_s);
}

AutopilotLog RowCollector::take(bool as_lines) {
    end();
    auto& tables = sender_.tables;
    count_gap(after_last_s);
    if (!has_times_ && early_ > 0)
        throw InputError({file_.string()}, fmt::format("no message has a time, also none of {} that are used", early_),
                         "in logs of ArduPilot before 3.1 only GPS has one: the aircraft had no GPS, or no fix");
    if (std::isnan(last_s_) && early_ > 0)
        skips_.add({SkipReason::no_time, without_time}, after_last_s, first_early_ + 1, early_);
    for (std::size_t t = 0; t < tables.size(); ++t) {
        std::size_t column = 0;
        std::erase_if(tables[t].columns, [&](const Column&) { return !is_bound_[t][column++]; });
    }
    std::erase_if(tables, [](const MessageTable& table) { return table.empty(); });
    auto& log = result_.log;
    log.data_file = file_;
    log.flight = flight_name(file_);
    for (auto& [kind, skipped] : skips_.take()) {
        const bool is_row = kind.reason == SkipReason::no_time;
        skipped.reason =
            is_row     ? kind.detail == damaged_time ? "messages whose time is damaged" : "messages without a time"
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
