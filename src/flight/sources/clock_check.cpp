#include "flight/sources/clock_check.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace flightwatt::flight {
namespace {

constexpr double restart_s = 60.0;
constexpr double late_s = 2.0;
constexpr std::size_t enough_late_rows = 10;
constexpr double hole_intervals = 1.5;
constexpr std::size_t min_intervals = 5;
constexpr std::size_t max_intervals = 100;

bool has_late_rows(const telemetry::MessageTable& table, double later_than_s) {
    double latest_s = -std::numeric_limits<double>::infinity();
    return std::ranges::any_of(table.time_s, [&](double time_s) {
        latest_s = std::max(latest_s, time_s);
        return latest_s - time_s > later_than_s;
    });
}

/// A jump back of a minute is another log, or another boot, behind the first one. Of all that show it, the pair of
/// times that shows it first.
std::optional<ClockRestart> restart_in(const telemetry::MessageTable& table) {
    std::optional<ClockRestart> restart;
    if (!has_late_rows(table, restart_s)) return restart;
    std::set<double> seen_s;
    for (const double time_s : table.time_s) {
        const auto first = seen_s.upper_bound(time_s + restart_s);
        if (first != seen_s.end() && (!restart || *first < restart->visible_from_s)) {
            restart = {*first, *seen_s.rbegin(), time_s, table.message};
        }
        seen_s.insert(time_s);
    }
    return restart;
}

/// A row that came before in the file, and the earliest time that shows it to be late (infinite: none).
struct SeenRow {
    std::size_t row;
    double late_by_s;
};
using SeenRows = std::multimap<double, SeenRow>;

bool differ(const telemetry::MessageTable& table, std::size_t a, std::size_t b) {
    return std::ranges::any_of(table.columns, [&](const telemetry::Column& column) {
        const double left = column.values[a];
        const double right = column.values[b];
        return left != right && !(std::isnan(left) && std::isnan(right));
    });
}

/// Whether a row lies where the rows before it in the file lack none. It looks at nothing later than `known_s`, so that
/// a log which ends there shows the same.
bool lies_over(const telemetry::MessageTable& table, std::size_t row, const SeenRows& seen, double known_s) {
    const double time_s = table.time_s[row];
    const auto counts = [&](SeenRows::const_iterator at) { return at->second.late_by_s > known_s; };
    auto above = seen.lower_bound(time_s);
    while (above != seen.end() && !counts(above)) ++above;
    if (above == seen.end()) return false;
    if (above->first == time_s) return differ(table, row, above->second.row);
    std::vector<double> before_s;
    for (auto at = seen.lower_bound(time_s); at != seen.begin() && before_s.size() <= max_intervals;) {
        --at;
        if (counts(at)) before_s.push_back(at->first);
    }
    if (before_s.size() <= min_intervals) return false;
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < before_s.size(); ++i) intervals_s.push_back(before_s[i - 1] - before_s[i]);
    const auto low = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 10);
    std::nth_element(intervals_s.begin(), low, intervals_s.end());
    return above->first - before_s.front() < hole_intervals * *low;
}

void add_overlaps(const telemetry::MessageTable& table, std::vector<ClockRestart>& overlaps) {
    if (!has_late_rows(table, late_s)) return;
    SeenRows seen;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        const double time_s = table.time_s[row];
        const auto shows_late = seen.upper_bound(time_s + late_s);
        const double known_s = shows_late == seen.end() ? std::numeric_limits<double>::infinity() : shows_late->first;
        if (std::isfinite(known_s) && lies_over(table, row, seen, known_s))
            overlaps.push_back({known_s, known_s, time_s, table.message});
        seen.emplace(time_s, SeenRow{row, known_s});
    }
}

}  // namespace

std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender) {
    std::optional<ClockRestart> first;
    std::vector<ClockRestart> overlaps;
    for (const auto& table : sender.tables) {
        const auto restart = restart_in(table);
        if (restart && (!first || restart->visible_from_s < first->visible_from_s)) first = restart;
        // Several devices report at one time and in any order.
        if (table.message != "ESC" && table.message != "POWER_DEVICE") add_overlaps(table, overlaps);
    }
    if (overlaps.size() < enough_late_rows) return first;
    std::ranges::sort(overlaps, {},
                      [](const ClockRestart& at) { return std::tuple(at.visible_from_s, at.to_s, at.message); });
    const auto& shown = overlaps[enough_late_rows - 1];
    return first && first->visible_from_s <= shown.visible_from_s ? first : shown;
}

}  // namespace flightwatt::flight
