#include "base/number.h"

#include <limits>

namespace flightwatt {
namespace {

constexpr std::int64_t hundred_millionths_per_whole = 100'000'000;

/// value * 10^8 where that is a whole number of at most 15 digits: no other number reads back from fewer digits.
std::optional<std::int64_t> as_hundred_millionths(double value) {
    constexpr double scale = 1e8;
    constexpr double most = 1e7;          // 15 digits
    constexpr double min_decimal = 1e-4;  // smaller numbers have an exponent
    if (!(value < most) || value < min_decimal) return std::nullopt;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): faster than llround; a wrong result is not equal below
    const auto whole = static_cast<std::int64_t>(value * scale + 0.5);
    if (static_cast<double>(whole) / scale != value) return std::nullopt;
    return whole;
}

/// Without zeros at its end.
char* write_hundred_millionths(char* to, std::int64_t value) {
    char* const end = to + number_buffer_size;
    to = std::to_chars(to, end, value / hundred_millionths_per_whole).ptr;
    const auto places = value % hundred_millionths_per_whole;
    if (places == 0) return to;
    char* const point = to;
    to = std::to_chars(to, end, hundred_millionths_per_whole + places).ptr;  // with a 1 where the point is
    *point = '.';
    while (to[-1] == '0') --to;
    return to;
}

}  // namespace

char* write_number(char* to, double value) {
    constexpr double min_fixed = 1e-4;  // beyond, an exponent is written
    constexpr double max_fixed = 1e16;
    const double magnitude = std::abs(value);
    if (const auto whole = as_hundred_millionths(magnitude)) {
        if (value < 0.0) *to++ = '-';
        return write_hundred_millionths(to, *whole);
    }
    const bool is_fixed = magnitude == 0.0 || (magnitude >= min_fixed && magnitude < max_fixed);
    const auto form = is_fixed ? std::chars_format::fixed : std::chars_format::scientific;
    return std::to_chars(to, to + max_number_chars, value, form).ptr;
}

namespace detail {

double number_or_nan_general(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, value);
    if (status != std::errc{} || stop != end || !std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    return value;
}

}  // namespace detail
}  // namespace flightwatt
