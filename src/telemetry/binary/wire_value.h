#pragma once

#include "telemetry/message_dictionary.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace flightwatt::telemetry {

/// A little-endian number of any alignment.
template <typename T>
T wire_number(const char* p) {
    T value;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&value, p, sizeof value);
    } else {
        char bytes[sizeof value];
        for (std::size_t i = 0; i < sizeof value; ++i) bytes[i] = p[sizeof value - 1 - i];
        std::memcpy(&value, bytes, sizeof value);
    }
    return value;
}

/// as_written() for what is far from one.
double as_written_slowly(float value);

/// The decimal number of fewest digits that a float is read from: 11.62 of the float 11.6199999. So a log reads the same
/// as the text that it is converted to.
inline double as_written(float value) {
    const double exact{value};
    const double magnitude = std::fabs(exact);
    if (!(magnitude < 1e9 && magnitude > 1e-9)) return exact == 0.0 ? exact : as_written_slowly(value);
    constexpr double tenths[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const auto rounded = [exact, &tenths](int decimals) {
        const double scaled = exact * tenths[decimals];
        return static_cast<double>(static_cast<std::int64_t>(scaled + std::copysign(0.5, scaled))) / tenths[decimals];
    };
    if (rounded(0) == exact) return exact;
    // Eight digits behind the leading zeros; most floats of sensors need seven to nine.
    constexpr double decades_per_octave = 0.30103;
    const int exponent = static_cast<int>(std::floor(decades_per_octave * std::ilogb(magnitude)));
    int decimals = std::max(0, std::min(22, 7 - exponent));
    while (decimals < 22 && static_cast<float>(rounded(decimals)) != value) ++decimals;
    while (decimals > 0 && static_cast<float>(rounded(decimals - 1)) == value) --decimals;
    return rounded(decimals);
}

/// One element as a number; a char is its code.
inline double wire_value(WireType type, const char* p) {
    switch (type) {
        case WireType::int8:
            return wire_number<std::int8_t>(p);
        case WireType::uint8:
        case WireType::text:
            return wire_number<std::uint8_t>(p);
        case WireType::int16:
            return wire_number<std::int16_t>(p);
        case WireType::uint16:
            return wire_number<std::uint16_t>(p);
        case WireType::int32:
            return wire_number<std::int32_t>(p);
        case WireType::uint32:
            return wire_number<std::uint32_t>(p);
        case WireType::int64:
            return static_cast<double>(wire_number<std::int64_t>(p));
        case WireType::uint64:
            return static_cast<double>(wire_number<std::uint64_t>(p));
        case WireType::float32:
            return as_written(wire_number<float>(p));
        case WireType::float64:
            return wire_number<double>(p);
    }
    return 0.0;
}

}  // namespace flightwatt::telemetry
