#pragma once

#include "telemetry/message_dictionary.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include <boost/endian/conversion.hpp>

namespace flightwatt::telemetry {

/// Returns the little-endian number at `p`, of any alignment.
template <typename T>
T wire_number(const char* p) {
    T value;
    std::memcpy(&value, p, sizeof value);
    boost::endian::little_to_native_inplace(value);
    return value;
}

/// Returns the little-endian bytes of a number.
template <typename T>
std::string wire_bytes(T number) {
    boost::endian::native_to_little_inplace(number);
    const auto bytes = std::bit_cast<std::array<char, sizeof number>>(number);
    return {bytes.begin(), bytes.end()};
}

/// Returns the decimal number of fewest digits that is read as this float: 11.62 for the float 11.6199999. So a binary
/// log and its text have the same values.
double shortest_decimal(float value);

/// Returns one element as a number; a char as its code.
inline double wire_value(WireType type, const char* p) {
    return with_wire_type(type, [&]<typename T>() -> double {
        if constexpr (std::is_same_v<T, char>) return wire_number<std::uint8_t>(p);
        if constexpr (std::is_same_v<T, float>) return shortest_decimal(wire_number<float>(p));
        return static_cast<double>(wire_number<T>(p));
    });
}

/// Calls use(WireField, first byte, number of elements) for each field of a payload that fits its definition.
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
