#pragma once

#include "telemetry/message_dictionary.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

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

/// shortest_decimal() for what is far from one.
double shortest_decimal_general(float value);

/// The decimal number of fewest digits that a float is read from: 11.62 of the float 11.6199999. So a log reads the
/// same as the text that it is converted to. `decimals`: how many it is likely to have, then how many it has; fields
/// mostly have as many from message to message.
inline double shortest_decimal(float value, int& decimals) {
    const double exact{value};
    const double magnitude = std::fabs(exact);
    if (!(magnitude < 1e9 && magnitude > 1e-9)) return exact == 0.0 ? exact : shortest_decimal_general(value);
    if (static_cast<double>(static_cast<std::int64_t>(exact)) == exact) return exact;
    static constexpr double tenths[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9, 1e10,
                                        1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20};
    const auto exponent = static_cast<int>(std::bit_cast<std::uint32_t>(value) >> 23 & 0xFFU) - 127;
    // What is nearer than half a step of floats is read as this float (or its neighbour: asked for at the end).
    const double half_step = std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent - 24) << 52);
    // Doubles of this size are whole numbers: a sum with it is rounded to the nearest, of two to the even one.
    constexpr double whole = 0x1.8p52;
    const auto digits_of = [exact](int places) { return exact * tenths[places] + whole - whole; };
    const auto reads_back = [&](int places) {
        return std::fabs(digits_of(places) - exact * tenths[places]) <= half_step * tenths[places];
    };
    // No float needs more than nine digits behind the leading zeros. 1233 / 4096 is log10(2).
    constexpr int max_decimals = 20;
    decimals = std::min(decimals, std::clamp(9 - (exponent * 1233 >> 12), 0, max_decimals - 2));
    while (decimals < max_decimals && !reads_back(decimals)) ++decimals;
    while (decimals > 0 && reads_back(decimals - 1)) --decimals;
    double number = digits_of(decimals) / tenths[decimals];
    while (decimals < max_decimals && static_cast<float>(number) != value) {
        ++decimals;
        number = digits_of(decimals) / tenths[decimals];
    }
    return number;
}

inline double shortest_decimal(float value) {
    int decimals = 4;  // often enough
    return shortest_decimal(value, decimals);
}

/// One element as a number; a char is its code. `decimals`: as for shortest_decimal().
inline double wire_value(WireType type, const char* p, int& decimals) {
    return with_wire_type(type, [&]<typename T>() -> double {
        if constexpr (std::is_same_v<T, char>) return wire_number<std::uint8_t>(p);
        if constexpr (std::is_same_v<T, float>) return shortest_decimal(wire_number<float>(p), decimals);
        return static_cast<double>(wire_number<T>(p));
    });
}

/// Calls use(WireField, first byte, how many elements) for each field of a payload that fits its definition.
template <typename Use>
void for_each_field(const WireMessage& message, std::string_view payload, Use&& use) {
    const char* p = payload.data();
    for (const auto& field : message.fields) {
        std::size_t elements = field.elements;
        if (field.count == WireCount::counted) elements = wire_number<std::uint8_t>(p++);
        use(field, p, elements);
        p += elements * size_of(field.type);
    }
}

}  // namespace flightwatt::telemetry
