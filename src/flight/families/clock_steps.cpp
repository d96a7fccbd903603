#include "flight/families/clock_steps.h"

#include "base/statistics.h"

#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double max_step_s = 10.0;      // by more another recording begins
constexpr double usual_intervals = 1.5;  // a longer one is the hole of late rows

/// The median interval between rows of different times that rise.
double rising_interval_s(const std::vector<double>& time_s) {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < time_s.size(); ++i)
        if (time_s[i] > time_s[i - 1]) intervals_s.push_back(time_s[i] - time_s[i - 1]);
    return intervals_s.empty() ? 0.0 : median_high(std::move(intervals_s));
}

/// Whether the clock passes the time before the row again, in two or more rows and without a hole.
bool is_set_back(const std::vector<double>& time_s, std::size_t row, double usual_s) {
    const double before_s = time_s[row - 1];
    if (time_s[row] >= before_s || time_s[row] < before_s - max_step_s) return false;
    for (auto i = row + 1; i < time_s.size(); ++i) {
        const double interval_s = time_s[i] - time_s[i - 1];
        if (interval_s < 0.0 || interval_s > usual_intervals * usual_s) return false;
        if (time_s[i] > before_s) return i > row + 1;
    }
    return false;
}

}  // namespace

std::optional<telemetry::SkippedLines> undo_clock_steps(std::vector<double>& time_s,
                                                        const std::vector<std::size_t>& lines) {
    const auto logged_s = time_s;
    const double usual_s = rising_interval_s(logged_s);
    telemetry::SkippedLines steps;
    double offset_s = 0.0;
    double together_s = 0.0;
    double first_s = logged_s.empty() ? 0.0 : logged_s.front();  // of the recording
    for (std::size_t i = 1; i < logged_s.size(); ++i) {
        if (logged_s[i] < logged_s[i - 1] - max_step_s) {
            offset_s = 0.0;
            first_s = logged_s[i];
        }
        if (logged_s[i] > first_s && is_set_back(logged_s, i, usual_s)) {
            const double step_s = logged_s[i - 1] + usual_s - logged_s[i];
            offset_s += step_s;
            together_s += step_s;
            steps.lines.push_back({logged_s[i] + offset_s, 1, lines[i]});
        }
        time_s[i] += offset_s;
    }
    if (steps.lines.empty()) return std::nullopt;
    steps.reason = fmt::format("the clock is set back by {:.1f} s, first at {:.1f} s: later times are that much later",
                               together_s, steps.lines.front().time_s);
    return steps;
}

}  // namespace flightwatt::flight
