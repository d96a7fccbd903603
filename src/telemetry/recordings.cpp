#include "telemetry/recordings.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

namespace flightwatt::telemetry {
namespace {

/// Rows out of order, and repeated ones, come up to so late.
constexpr double late_s = 2.0;
constexpr std::size_t enough_rows = 10;
constexpr auto no_end = std::numeric_limits<std::size_t>::max();

struct PlacedRow {
    std::size_t place;
    double time_s;
};
using PlacedRows = std::vector<PlacedRow>;

/// The rows of all messages and senders in the order of the file.
PlacedRows rows_in_order(const TelemetryLog& log) {
    PlacedRows rows;
    for (const auto& sender : log.senders)
        for (const auto& table : sender.tables)
            for (std::size_t i = 0; i < table.places.size(); ++i) rows.push_back({table.places[i], table.time_s[i]});
    std::ranges::sort(rows, {}, &PlacedRow::place);
    return rows;
}

/// Whether ten of the hundred rows before `end`, not before `begin`, are later than a time.
bool has_later_rows(const PlacedRows& rows, std::size_t begin, std::size_t end, double time_s) {
    constexpr std::size_t max_rows = 100;
    const auto is_later = [&](const PlacedRow& row) { return row.time_s > time_s + late_s; };
    const auto last = rows.begin() + static_cast<std::ptrdiff_t>(end);
    const auto count =
        std::count_if(last - static_cast<std::ptrdiff_t>(std::min(end - begin, max_rows)), last, is_later);
    return count >= static_cast<std::ptrdiff_t>(enough_rows);
}

/// Rows behind the time `from_s` of the clock before them.
struct LateRows {
    std::size_t end = 0;
    bool is_other_clock = false;  ///< a jump back to the former clock does not end them
};

LateRows late_rows(const PlacedRows& rows, std::size_t begin, double from_s) {
    constexpr double max_jump = 0.5;  // of the fall
    constexpr double max_ahead_s = 10.0;
    double reached_s = rows[begin].time_s;
    auto end = begin;
    for (; end < rows.size() && rows[end].time_s <= from_s - late_s; ++end)
        reached_s = std::max(reached_s, rows[end].time_s);
    const bool is_long = end - begin >= enough_rows;
    if (end == rows.size()) return {end, is_long};
    const double back_s = rows[end].time_s;
    const bool jumps = back_s - reached_s > max_jump * (from_s - rows[begin].time_s) && back_s <= from_s + max_ahead_s;
    return {end, is_long && !jumps};
}

/// The rows at which another recording may begin.
std::vector<std::size_t> falls_of_clock(const PlacedRows& rows) {
    std::vector<std::size_t> falls;
    double latest_s = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows.size() && falls.size() < max_recordings;) {
        const double time_s = rows[i].time_s;
        if (time_s > latest_s - late_s) {
            latest_s = std::max(latest_s, time_s);
            ++i;
        } else if (!has_later_rows(rows, falls.empty() ? 0 : falls.back(), i, time_s)) {
            latest_s = time_s;  // a few rows were ahead
        } else if (const auto late = late_rows(rows, i, latest_s); late.is_other_clock) {
            falls.push_back(i);
            latest_s = time_s;
        } else {
            i = late.end;
        }
    }
    return falls;
}

/// The rows of a sender with places from `begin` to before `end`; tables without any are left out.
SenderLog rows_between(const SenderLog& sender, std::size_t begin, std::size_t end) {
    SenderLog part{sender.id, {}};
    for (const auto& table : sender.tables) {
        const auto first = std::ranges::lower_bound(table.places, begin) - table.places.begin();
        const auto last = std::ranges::lower_bound(table.places, end) - table.places.begin();
        if (first == last) continue;
        const auto cut = [&](const auto& values) { return std::vector(values.begin() + first, values.begin() + last); };
        auto& rows = part.tables.emplace_back(MessageTable{table.message, cut(table.time_s), {}, cut(table.places)});
        for (const auto& column : table.columns)
            rows.columns.push_back({column.field, column.quantity, cut(column.values), column.is_integer});
    }
    return part;
}

/// The assumptions about messages of the part, from its first such message on.
std::vector<AssumedDefinition> assumptions_of(const std::vector<AssumedDefinition>& all, const TelemetryLog& part) {
    std::vector<AssumedDefinition> own;
    for (const auto& assumed : all) {
        double since_s = std::numeric_limits<double>::infinity();
        for (const auto& sender : part.senders)
            if (const auto* table = sender.table(std::string_view(assumed.text).substr(0, assumed.text.find(':'))))
                since_s = std::min(since_s, std::ranges::min(table->time_s));
        if (since_s < std::numeric_limits<double>::infinity()) own.push_back({assumed.text, since_s});
    }
    return own;
}

/// The part of a log from the place `begin` to before `end`.
TelemetryLog part_of(const TelemetryLog& log, std::size_t begin, std::size_t end) {
    TelemetryLog part{log.data_file, log.flight, log.configuration, {}, {}, {}, log.lines};
    for (const auto& sender : log.senders)
        if (auto rows = rows_between(sender, begin, end); !rows.tables.empty()) part.senders.push_back(std::move(rows));
    for (auto skipped : log.skipped) {
        std::erase_if(skipped.lines, [&](const auto& at) { return at.first_line < begin || at.first_line >= end; });
        if (!skipped.lines.empty()) part.skipped.push_back(std::move(skipped));
    }
    part.assumed_definitions = assumptions_of(log.assumed_definitions, part);
    return part;
}

/// The first places of the recordings, and the end of the last. Lines without a time before a row belong to it.
std::vector<std::size_t> bounds_of(const TelemetryLog& log, const ShowsRestart& shows_restart) {
    const auto rows = rows_in_order(log);
    const auto falls = falls_of_clock(rows);
    if (falls.size() >= max_recordings) return {0, no_end};
    const auto bound = [&](std::size_t fall) { return rows[fall - 1].place + 1; };
    std::vector<std::size_t> bounds{0};
    for (std::size_t i = 0; i < falls.size(); ++i) {
        const auto end = i + 1 < falls.size() ? bound(falls[i + 1]) : no_end;
        const auto restarts = [&](const SenderLog& all) {
            return shows_restart(rows_between(all, bounds.back(), end));
        };
        if (std::ranges::any_of(log.senders, restarts)) bounds.push_back(bound(falls[i]));
    }
    bounds.push_back(no_end);
    return bounds;
}

}  // namespace

std::vector<TelemetryLog> split_recordings(TelemetryLog log, const ShowsRestart& shows_restart) {
    std::vector<TelemetryLog> parts;
    std::vector<std::size_t> bounds;
    if (std::ranges::any_of(log.senders, shows_restart)) bounds = bounds_of(log, shows_restart);
    for (std::size_t i = 0; bounds.size() > 2 && i + 1 < bounds.size(); ++i)
        parts.push_back(part_of(log, bounds[i], bounds[i + 1]));
    if (parts.empty()) parts.push_back(std::move(log));
    return parts;
}

}  // namespace flightwatt::telemetry
