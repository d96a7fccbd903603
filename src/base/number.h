#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string_view>

namespace flightwatt {

namespace detail {
inline constexpr double powers_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                           1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// The general case: exponents, 16 digits and more, and everything that is not a number. Kept out of line,
/// because its stack frame would slow the short decimals down.
double number_or_nan_general(std::string_view text);

}  // namespace detail

/// The number that the whole of `text` spells, correctly rounded; NaN for anything else: an empty field,
/// "12,5", "12.5x", "nan", "inf", " 1". OCaml's "235." and "-0." are numbers. Hot path of the log reader:
/// short decimals are exact as integer / power of ten (both below 2^53), the rest goes to from_chars. (NaN,
/// and no optional, because GCC 12 passes that through memory: written in two parts, read as one, it stalls.)
inline double number_or_nan(std::string_view text) {
    const char* p = text.data();
    const char* const end = p + text.size();
    const bool negative = p != end && *p == '-';
    if (negative) ++p;
    std::uint64_t digits = 0;
    const char* const first = p;
    while (p != end && static_cast<unsigned char>(*p - '0') < 10) {
        digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
    }
    auto count = p - first;
    std::ptrdiff_t decimals = 0;
    if (p != end && *p == '.') {
        ++p;
        decimals = end - p;
        count += decimals;
        while (p != end && static_cast<unsigned char>(*p - '0') < 10) {
            digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
        }
    }
    if (p != end || count == 0 || count > 15) return detail::number_or_nan_general(text);
    const double magnitude = static_cast<double>(static_cast<std::int64_t>(digits)) / detail::powers_of_ten[decimals];
    return negative ? -magnitude : magnitude;
}

/// number_or_nan with std::nullopt for other texts.
inline std::optional<double> parse_number(std::string_view text) {
    const double number = number_or_nan(text);
    return std::isnan(number) ? std::nullopt : std::optional(number);
}

/// The whole of `text` as a non-negative integer; std::nullopt for anything else.
inline std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
    std::uint64_t value = 0;
    const auto [stop, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Returns, by bisection, the last value for which `holds` is true between `from`, where it is, and `to`, where it is not.
/// Neither of them is tried, and `to` may be the lesser.
template <typename Predicate>
double last_true(double from, double to, int halvings, const Predicate& holds) {
    for (int i = 0; i < halvings; ++i) {
        const double middle = std::midpoint(from, to);
        (holds(middle) ? from : to) = middle;
    }
    return from;
}

}  // namespace flightwatt
