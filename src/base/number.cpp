#include "base/number.h"

#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace flightwatt {
namespace {

constexpr std::uint64_t eight_places = 100'000'000;  // 10^8
constexpr std::uint64_t whole_powers_of_ten[] = {1ULL,
                                                 10ULL,
                                                 100ULL,
                                                 1'000ULL,
                                                 10'000ULL,
                                                 100'000ULL,
                                                 1'000'000ULL,
                                                 10'000'000ULL,
                                                 100'000'000ULL,
                                                 1'000'000'000ULL,
                                                 10'000'000'000ULL,
                                                 100'000'000'000ULL,
                                                 1'000'000'000'000ULL,
                                                 10'000'000'000'000ULL,
                                                 100'000'000'000'000ULL,
                                                 1'000'000'000'000'000ULL,
                                                 10'000'000'000'000'000ULL,
                                                 100'000'000'000'000'000ULL,
                                                 1'000'000'000'000'000'000ULL,
                                                 10'000'000'000'000'000'000ULL};

/// value * 10^8 where that is a whole number of at most 15 digits: no other number reads back from fewer digits.
std::optional<std::uint64_t> as_hundred_millionths(double value) {
    constexpr double scale = 1e8;
    constexpr double most = 1e7;    // 15 digits
    constexpr double least = 1e-4;  // what is less is written with an exponent
    if (!(value < most) || value < least) return std::nullopt;
    constexpr double max_rounded = 4.0 * std::numeric_limits<double>::epsilon();  // far more than product and quotient
    const double scaled = value * scale;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): quicker than llround, and what is rounded wrong is not equal below
    const auto whole = static_cast<double>(static_cast<std::int64_t>(scaled + 0.5));
    if (std::abs(scaled - whole) > max_rounded * scaled) return std::nullopt;  // quicker than to divide
    if (whole / scale != value) return std::nullopt;
    return static_cast<std::uint64_t>(whole);
}

/// The eight digits of a number below 10^8, one a byte, the first in the lowest. By four, two and one digit at a time,
/// several at once; what is divided is so small that a product and a shift give the exact quotient.
inline std::uint64_t eight_digits(std::uint64_t value) {
    const std::uint64_t fours = value / 10'000 | value % 10'000 << 32;
    const std::uint64_t hundreds = (fours * 10'486 >> 20) & 0x0000'007f'0000'007f;
    const std::uint64_t twos = hundreds | (fours - 100 * hundreds) << 16;
    const std::uint64_t tens = (twos * 103 >> 10) & 0x000f'000f'000f'000f;
    return tens | (twos - 10 * tens) << 8;
}

/// Writes digits as eight_digits gives them: always eight characters, of which the caller keeps what it wants.
inline void write_eight(char* to, std::uint64_t digits) {
    std::uint64_t text = digits | 0x3030'3030'3030'3030;
    if constexpr (std::endian::native == std::endian::big) text = __builtin_bswap64(text);
    std::memcpy(to, &text, sizeof text);
}

/// A whole number below 10^8.
inline char* write_up_to_eight(char* to, std::uint64_t value) {
    if (value < 10) {
        *to = static_cast<char>('0' + value);
        return to + 1;
    }
    constexpr std::uint64_t in_last_place = std::uint64_t{1} << 56;
    const auto digits = eight_digits(value);
    const int leading = std::countr_zero(digits | in_last_place) / 8;
    write_eight(to, digits >> (8 * leading));
    return to + (8 - leading);
}

/// A whole number below 10^16.
char* write_whole(char* to, std::uint64_t value) {
    if (value < eight_places) return write_up_to_eight(to, value);
    to = write_up_to_eight(to, value / eight_places);
    write_eight(to, eight_digits(value % eight_places));
    return to + 8;
}

/// A whole number as that many decimal places, 24 at most.
char* write_places(char* to, std::uint64_t value, std::ptrdiff_t places) {
    constexpr std::ptrdiff_t max_at_once = 16;
    if (places > max_at_once) {
        to = write_places(to, value / eight_places, places - 8);
        write_eight(to, eight_digits(value % eight_places));
        return to + 8;
    }
    value *= whole_powers_of_ten[max_at_once - places];
    write_eight(to, eight_digits(value / eight_places));
    write_eight(to + 8, eight_digits(value % eight_places));
    return to + places;
}

/// A number from 10^-4 to below 10^16 of any digits, fewest that read back as the same.
char* write_shortest(char* to, double value) {
    // What fmt's "{}" takes the digits from; it spends most of its time on laying them out.
    const auto [digits, exponent] = fmt::detail::dragonbox::to_decimal(value);
    if (exponent >= 0) return write_whole(to, digits * whole_powers_of_ten[exponent]);
    // Digits that stood for the next whole number would read back as that: they begin with this one.
    const auto whole = static_cast<std::uint64_t>(value);
    to = write_whole(to, whole);
    *to = '.';
    return write_places(to + 1, whole == 0 ? digits : digits - whole * whole_powers_of_ten[-exponent], -exponent);
}

}  // namespace

char* write_number(char* to, double value) {
    constexpr double min_fixed = 1e-4;  // beyond, an exponent is written
    constexpr double max_fixed = 1e16;
    const double magnitude = std::abs(value);
    if (magnitude == 0.0 && !std::signbit(value)) return write_whole(to, 0);
    const auto hundred_millionths = as_hundred_millionths(magnitude);
    if (!hundred_millionths && !(magnitude >= min_fixed && magnitude < max_fixed))
        return fmt::format_to(to, "{}", value);
    if (value < 0.0) *to++ = '-';
    if (!hundred_millionths) return write_shortest(to, magnitude);
    to = write_up_to_eight(to, *hundred_millionths / eight_places);
    const auto digits = eight_digits(*hundred_millionths % eight_places);
    if (digits == 0) return to;
    *to = '.';
    write_eight(to + 1, digits);
    return to + 9 - std::countl_zero(digits) / 8;
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
