#include "telemetry/text/skip_counter.h"

#include <algorithm>
#include <limits>

namespace flightwatt::telemetry {
namespace {

/// Appends a count, or adds it to the last one if that has the same time.
void append_count(std::vector<SkippedLines::AtTime>& lines, const SkippedLines::AtTime& at) {
    if (!lines.empty() && lines.back().time_s == at.time_s) {
        lines.back().count += at.count;
    } else {
        lines.push_back(at);
    }
}

}  // namespace

SkippedLines& SkipCounter::lines_of(Counts& counts, const SkipKind& kind) {
    const auto known = std::ranges::find(counts, kind, &Counts::value_type::first);
    return known == counts.end() ? counts.emplace_back(kind, SkippedLines{}).second : known->second;
}

void SkipCounter::add(const SkipKind& kind, double time_s, std::size_t line_number, std::size_t count) {
    append_count(lines_of(skips_, kind).lines, {time_s, count, line_number});
}

void SkipCounter::add_without_time(const SkipKind& kind, std::size_t line_number) {
    append_count(lines_of(untimed_, kind).lines, {0.0, 1, line_number});
}

void SkipCounter::set_time(double time_s) {
    for (const auto& [kind, skipped] : untimed_)
        for (const auto& at : skipped.lines) add(kind, time_s, at.first_line, at.count);
    untimed_.clear();
}

std::vector<std::pair<SkipKind, SkippedLines>> SkipCounter::take() {
    set_time(std::numeric_limits<double>::infinity());
    for (auto& [kind, skipped] : skips_) {
        std::ranges::stable_sort(skipped.lines, {}, &SkippedLines::AtTime::time_s);
        std::vector<SkippedLines::AtTime> merged;
        for (const auto& at : skipped.lines) append_count(merged, at);
        skipped.lines = std::move(merged);
    }
    std::ranges::sort(skips_, {}, [](const auto& skip) { return skip.second.first_line(); });
    return std::move(skips_);
}

}  // namespace flightwatt::telemetry
