#include "base/number.h"

#include <cstring>
#include <limits>

#include <fmt/format.h>

namespace flightwatt {
namespace {

/// value * 10^8 where that is a whole number of at most 15 digits: no other number reads back from fewer digits.
std::optional<std::int64_t> as_hundred_millionths(double value) {
    constexpr double scale = 1e8;
    constexpr double most = 1e7;    // 15 digits
    constexpr double least = 1e-4;  // what is less is written with an exponent
    if (!(value < most) || value < least) return std::nullopt;
    const auto whole = std::llround(value * scale);
    if (static_cast<double>(whole) / scale != value) return std::nullopt;
    return whole;
}

char* write_digits(char* to, std::uint64_t value) {
    const fmt::format_int text(value);
    std::memcpy(to, text.data(), text.size());
    return to + text.size();
}

}  // namespace

char* write_number(char* to, double value) {
    const double magnitude = std::abs(value);
    if (magnitude == 0.0 && !std::signbit(value)) return write_digits(to, 0);
    const auto hundred_millionths = as_hundred_millionths(magnitude);
    if (!hundred_millionths) return fmt::format_to(to, "{}", value);
    if (value < 0.0) *to++ = '-';
    constexpr std::uint64_t one = 100'000'000;
    const auto whole = static_cast<std::uint64_t>(*hundred_millionths);
    to = write_digits(to, whole / one);
    auto part = whole % one;
    if (part == 0) return to;
    *to = '.';
    int digits = 8;
    for (; part % 10 == 0; part /= 10) --digits;
    for (int i = digits; i > 0; --i, part /= 10) to[i] = static_cast<char>('0' + part % 10);
    return to + 1 + digits;
}

namespace detail {

double number_or_nan_slowly(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, value);
    if (status != std::errc{} || stop != end || !std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    return value;
}

}  // namespace detail
}  // namespace flightwatt
