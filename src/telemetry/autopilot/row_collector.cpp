#include "telemetry/autopilot/row_collector.h"

#include "base/error.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::telemetry {
namespace {

constexpr double max_back_s = 1.0;  // messages are written in almost the order of their times
constexpr double max_ahead_s = 10.0;
constexpr std::size_t max_skipped = 64'000'000;

bool continues_clock(double time_s, double from_s) {
    return time_s >= from_s - max_back_s && time_s <= from_s + max_ahead_s;
}

}  // namespace

RowCollector::RowCollector(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted)
    : file_(file), wanted_(wanted) {}

const MessageRequest* RowCollector::request_of(std::string_view message) const {
    const auto found = std::ranges::find(wanted_, message, &MessageRequest::message);
    return found == wanted_.end() ? nullptr : &*found;
}

std::size_t RowCollector::table_of(std::string_view message) {
    const auto found = std::ranges::find(sender_.tables, message, &MessageTable::message);
    const auto index = static_cast<std::size_t>(found - sender_.tables.begin());
    if (found == sender_.tables.end()) sender_.tables.push_back({std::string(message), {}, {}});
    return index;
}

void RowCollector::add_column(std::size_t table, const std::string& field) {
    auto& of = sender_.tables[table];
    if (of.column(field) != nullptr) return;
    of.columns.push_back(
        {field, std::nullopt, std::vector<double>(of.time_s.size(), std::numeric_limits<double>::quiet_NaN())});
}

void RowCollector::append(const Row& row) {
    auto& table = sender_.tables[row.table];
    table.time_s.push_back(row.time_s);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
        table.columns[i].values.push_back(i < row.values.size() ? row.values[i]
                                                                : std::numeric_limits<double>::quiet_NaN());
}

void RowCollector::drop(const std::optional<Row>& row) {
    if (row) skips_.add({SkipReason::no_time, 0}, std::isnan(last_s_) ? row->time_s : last_s_, row->offset + 1);
}

void RowCollector::count_gap(double time_s) {
    if (gap_ > 0) skips_.add({SkipReason::damage, 0}, time_s, gap_offset_ + 1, gap_);
    gap_ = 0;
}

void RowCollector::add(Row row) {
    if (std::isnan(row.time_s)) {
        if (std::isnan(last_s_)) ++untimed_;  // events before the first time
        if (!std::isnan(last_s_)) skips_.add({SkipReason::no_time, 0}, last_s_, row.offset + 1);
        return;
    }
    if (!continues_clock(row.time_s, last_s_)) {  // also at the beginning
        if (!pending_ || !continues_clock(row.time_s, pending_->time_s)) {
            drop(pending_);
            pending_ = std::move(row);
            return;
        }
        append(*pending_);
    } else {
        drop(pending_);
    }
    pending_.reset();
    count_gap(row.time_s);
    last_s_ = row.time_s;
    append(row);
}

void RowCollector::skip(std::size_t offset, std::size_t count) {
    if (count == 0) return;
    if (gap_ == 0) gap_offset_ = offset;
    gap_ += count;
    skipped_ += count;
    if (skipped_ <= max_skipped) return;
    throw InputError({file_.string()}, "has more than 64 MB that are no messages",
                     "is it a whole log of an autopilot?");
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
    end();
    count_gap(std::numeric_limits<double>::infinity());
    const bool has_rows = std::ranges::any_of(sender_.tables, [](const MessageTable& table) { return !table.empty(); });
    if (!has_rows && untimed_ > 0)
        skips_.add({SkipReason::no_time, 0}, std::numeric_limits<double>::infinity(), 1, untimed_);
    AutopilotLog result;
    result.facts = std::move(facts);
    auto& log = result.log;
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
    std::erase_if(sender_.tables, [](const MessageTable& table) { return table.empty(); });
    log.senders.push_back(std::move(sender_));
    return result;
}

}  // namespace flightwatt::telemetry
