#include "telemetry/text/skip_counter.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::telemetry {
namespace {

/// The time of a line "TIME SENDER NAME ..."; NaN for any other.
double time_of(std::string_view line) {
    const auto first = std::min(line.find(' '), line.size());
    const auto second = line.find(' ', first + 1);
    const bool is_message = second != std::string_view::npos && second + 1 < line.size();
    return is_message ? number_or_nan(line.substr(0, first)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void SkipCounter::add(const SkipKind& kind, double time_s, std::size_t line_number, std::size_t count) {
    auto known = std::ranges::find(skips_, kind, &std::pair<SkipKind, SkippedLines>::first);
    if (known == skips_.end()) known = skips_.insert(known, {kind, {}});
    auto& lines = known->second.lines;
    if (!lines.empty() && lines.back().time_s == time_s) {
        lines.back().count += count;
    } else {
        lines.push_back({time_s, count, line_number});
    }
}

void SkipCounter::append(const SkipCounter& later, std::size_t lines_before) {
    for (const auto& [kind, skipped] : later.skips_)
        for (const auto& at : skipped.lines) add(kind, at.time_s, lines_before + at.first_line, at.count);
}

void SkipCounter::add_without_time(const SkipKind& kind, const ScannedLine& line) {
    add(kind, time_behind_s(line.end), line.number);
}

double SkipCounter::time_behind_s(const char* line_end) {
    if (searched_from_ <= line_end && line_end < searched_to_) return found_s_;
    // The last lines are scanned in a copy, which ends in zeros.
    const char* const text_end = text_.data() + text_.size();
    const bool in_text = line_end >= text_.data() && line_end < text_end;
    std::string_view rest = in_text ? std::string_view(line_end, static_cast<std::size_t>(text_end - line_end))
                                    : std::string_view(line_end);
    searched_from_ = line_end;
    found_s_ = std::numeric_limits<double>::infinity();
    while (!rest.empty()) {
        const auto line = rest.substr(0, rest.find('\n'));
        const double time_s = time_of(line);
        searched_to_ = line.data();
        if (!std::isnan(time_s)) return found_s_ = time_s;
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    }
    searched_to_ = rest.data();
    return found_s_;
}

std::vector<std::pair<SkipKind, SkippedLines>> SkipCounter::take() {
    for (auto& [kind, skipped] : skips_) {
        auto& lines = skipped.lines;
        std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
        std::vector<SkippedLines::AtTime> merged;
        for (const auto& at : lines) {
            if (!merged.empty() && merged.back().time_s == at.time_s) {
                merged.back().count += at.count;
            } else {
                merged.push_back(at);
            }
        }
        lines = std::move(merged);
    }
    std::sort(skips_.begin(), skips_.end(),
              [](const auto& a, const auto& b) { return a.second.first_line() < b.second.first_line(); });
    return std::move(skips_);
}

}  // namespace flightwatt::telemetry
