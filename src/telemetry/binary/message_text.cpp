#include "telemetry/binary/message_text.h"

#include "telemetry/binary/wire_value.h"

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>

namespace flightwatt::telemetry {
namespace {

template <typename Number>
void append_number(Number number, std::string& text) {
    if constexpr (std::floating_point<Number>) {
        if (std::isnan(number)) {
            text += "nan";
            return;
        }
    }
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    const std::string_view shown(digits.data(), static_cast<std::size_t>(written.ptr - digits.data()));
    text += shown;
    if constexpr (std::floating_point<Number>) {
        if (shown.find_first_of(".en") == std::string_view::npos) text += '.';  // "235.", as OCaml writes it
    }
}

/// What would end a line or a quoted field stands for nothing else.
char shown_character(char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < ' ' || code == 0x7F || c == '"' ? '?' : c;
}

void append_element(WireType type, const char* p, std::string& text) {
    switch (type) {
        case WireType::text:
            text += *p == ' ' ? '?' : shown_character(*p);
            break;
        case WireType::float32:
            append_number(shortest_decimal(wire_number<float>(p)), text);
            break;
        case WireType::float64:
            append_number(wire_number<double>(p), text);
            break;
        case WireType::int64:
            append_number(wire_number<std::int64_t>(p), text);
            break;
        case WireType::uint64:
            append_number(wire_number<std::uint64_t>(p), text);
            break;
        default: {
            int decimals = 0;
            append_number(static_cast<std::int64_t>(wire_value(type, p, decimals)), text);
        }
    }
}

/// Zeros behind it fill a char[n] up.
void append_quoted(std::string_view characters, std::string& text) {
    while (!characters.empty() && characters.back() == '\0') characters.remove_suffix(1);
    text += '"';
    for (const char c : characters) text += shown_character(c);
    text += '"';
}

}  // namespace

double shortest_decimal_general(float value) {
    if (!std::isfinite(value)) return double{value};
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    double number = 0.0;
    std::from_chars(digits.data(), written.ptr, number);
    return number;
}

void append_message_text(const FoundFrame& found, std::string& text) {
    append_number(unsigned{found.sender}, text);
    text += ' ';
    text += found.message->definition.name;
    const char* p = found.fields.data();
    for (const auto& field : found.message->fields) {
        text += ' ';
        std::size_t elements = field.elements;
        if (field.count == WireCount::counted) elements = wire_number<std::uint8_t>(p++);
        const auto size = size_of(field.type);
        if (field.type == WireType::text && field.count != WireCount::one) {
            append_quoted({p, elements}, text);
            p += elements;
            continue;
        }
        for (std::size_t i = 0; i < elements; ++i, p += size) {
            if (i > 0) text += ',';
            append_element(field.type, p, text);
        }
    }
}

void read_message_values(const FoundFrame& found, std::vector<double>& values) {
    values.clear();
    const char* p = found.fields.data();
    for (const auto& field : found.message->fields) {
        std::size_t elements = field.elements;
        if (field.count == WireCount::counted) elements = wire_number<std::uint8_t>(p++);
        int decimals = 4;  // often enough
        const bool is_number = elements == 1 && field.type != WireType::text;
        const double value = is_number ? wire_value(field.type, p, decimals) : std::nan("");
        values.push_back(std::isfinite(value) ? value : std::nan(""));
        p += elements * size_of(field.type);
    }
}

}  // namespace flightwatt::telemetry
