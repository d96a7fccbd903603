#include "base/clock_time.h"

#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace flightwatt {
namespace {

constexpr double seconds_per_day = 24.0 * units::seconds_per_hour;

/// Takes a number of up to `digits` digits from the front.
std::optional<unsigned> take_number(std::string_view& text, std::size_t digits) {
    const auto size = std::min(text.find_first_not_of("0123456789"), text.size());
    if (size == 0 || size > digits) return std::nullopt;
    const auto number = parse_unsigned(text.substr(0, size));
    text.remove_prefix(size);
    return static_cast<unsigned>(*number);
}

bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
}

/// "2026-01-02", as seconds since 1970.
std::optional<double> take_date(std::string_view& text) {
    constexpr std::size_t year_digits = 4;
    const auto year = take_number(text, year_digits);
    const char mark = text.starts_with('/') ? '/' : '-';
    if (!year || *year < 1000 || !take(text, mark)) return std::nullopt;
    const auto month = take_number(text, 2);
    if (!month || !take(text, mark)) return std::nullopt;
    const auto day = take_number(text, 2);
    if (!day) return std::nullopt;
    using namespace std::chrono;
    const year_month_day date{std::chrono::year(static_cast<int>(*year)), std::chrono::month(*month),
                              std::chrono::day(*day)};
    if (!date.ok()) return std::nullopt;
    return static_cast<double>(sys_days(date).time_since_epoch().count()) * seconds_per_day;
}

/// " PM" or "am", if it follows: whether it is the afternoon.
std::optional<bool> take_half_of_day(std::string_view& text) {
    const auto rest = text.starts_with(' ') ? text.substr(1) : text;
    for (const std::string_view half : {"AM", "am", "PM", "pm"}) {
        if (!rest.starts_with(half)) continue;
        text = rest.substr(half.size());
        return half.starts_with('P') || half.starts_with('p');
    }
    return std::nullopt;
}

/// "10:17:15.060", also "10:17:15 AM", as seconds of the day.
std::optional<double> take_time(std::string_view& text) {
    const auto hours = take_number(text, 2);
    if (!hours || *hours > 23 || !take(text, ':')) return std::nullopt;
    const auto minutes = take_number(text, 2);
    if (!minutes || *minutes > 59 || !take(text, ':')) return std::nullopt;
    const auto seconds = take_number(text, 2);
    if (!seconds || *seconds > 60) return std::nullopt;  // of a leap second
    double time_s = *hours * units::seconds_per_hour + *minutes * units::seconds_per_minute + *seconds;
    if (text.starts_with('.') || text.starts_with(',')) {
        const auto size = std::min(text.find_first_not_of("0123456789", 1), text.size());
        const auto fraction = parse_unsigned(text.substr(1, size - 1));
        if (!fraction) return std::nullopt;
        time_s += static_cast<double>(*fraction) / std::pow(10.0, static_cast<double>(size - 1));
        text.remove_prefix(size);
    }
    const auto is_afternoon = take_half_of_day(text);
    if (!is_afternoon) return time_s;
    constexpr unsigned noon = 12;
    if (*hours == 0 || *hours > noon) return std::nullopt;
    return time_s + ((*is_afternoon ? noon : 0.0) - (*hours == noon ? noon : 0.0)) * units::seconds_per_hour;
}

/// "Z", "+01:00", "+0100" or nothing, as seconds ahead of UTC.
std::optional<double> take_zone(std::string_view& text) {
    if (text.empty() || take(text, 'Z')) return 0.0;
    const double sign = text.starts_with('-') ? -1.0 : 1.0;
    if (!take(text, '+') && !take(text, '-')) return std::nullopt;
    constexpr std::size_t both_digits = 4;
    constexpr unsigned hour = 100;
    const bool are_joined = text.size() == both_digits && text.find(':') == std::string_view::npos;
    const auto number = take_number(text, are_joined ? both_digits : 2);
    const auto minutes = are_joined ? number : take(text, ':') ? take_number(text, 2) : 0U;
    if (!number || !minutes) return std::nullopt;
    return sign * ((are_joined ? *number / hour : *number) * units::seconds_per_hour +
                   *minutes % hour * units::seconds_per_minute);
}

}  // namespace

std::optional<ClockTime> parse_clock_time(std::string_view text) {
    ClockTime time;
    auto rest = text;
    if (const auto date_s = take_date(rest)) {
        time.has_date = true;
        time.time_s = *date_s;
        if (rest.empty()) return time;
        if (!take(rest, 'T') && !take(rest, ' ')) return std::nullopt;
    } else {
        rest = text;
    }
    const auto of_day_s = take_time(rest);
    const auto zone_s = take_zone(rest);
    if (!of_day_s || !zone_s || !rest.empty()) return std::nullopt;
    time.has_time = true;
    time.time_s += *of_day_s - *zone_s;
    return time;
}

std::optional<double> TimeColumn::read(std::string_view cell, std::string_view date) {
    const double ticks = number_or_nan(cell);
    const auto clock = std::isnan(ticks) ? parse_clock_time(cell) : std::nullopt;
    const bool is_clock = clock && clock->has_time;
    if ((std::isnan(ticks) && !is_clock) || (has_started_ && is_clock != is_clock_)) return std::nullopt;
    const auto day = date.empty() ? std::nullopt : parse_clock_time(date);
    auto date_s = day && day->has_date ? std::optional(day->time_s) : std::nullopt;
    double time_s = 0.0;
    if (!is_clock) {  // dividing by 1e6 is exact, multiplying by 1e-6 is not
        time_s = tick_s_ < 1.0 ? ticks / std::round(1.0 / tick_s_) : ticks * tick_s_;
    } else if (clock->has_date) {
        date_s = time_s = clock->time_s;
    } else if (date_s) {
        date_s = time_s = *date_s + clock->time_s;
    } else {  // of the day on which it is nearest to the time before
        const double days = has_started_ ? std::round((last_s_ - clock->time_s) / seconds_per_day) : 0.0;
        time_s = clock->time_s + days * seconds_per_day;
    }
    is_clock_ = is_clock;
    if (!has_started_) start(time_s, date_s);
    last_s_ = time_s;
    return time_s - zero_s_;
}

void TimeColumn::start(double first_s, std::optional<double> date_s) {
    has_started_ = true;
    if (is_unix_) date_s = first_s;
    if (is_clock_ || is_unix_) zero_s_ = first_s;
    if (date_s) start_clock_s_ = *date_s - (first_s - zero_s_);
}

}  // namespace flightwatt
