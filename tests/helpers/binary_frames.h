#pragma once

#include "base/number.h"
#include "telemetry/link_decoder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Binary messages as aircraft send them, made from lines of a .data by definitions.
namespace flightwatt::test {

using telemetry::Framing;
using telemetry::LinkVersion;

/// The other parts of a v2 header.
struct Addressing {
    std::uint8_t destination = 0xFF;  ///< all
    std::uint8_t component = 0;
};

namespace detail {

template <typename Number>
void append_little_endian(std::string& bytes, Number number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof number);  // on little-endian machines
    for (std::size_t i = 0; i < sizeof number; ++i) bytes += static_cast<char>(bits >> (8 * i) & 0xFF);
}

inline void append_value(std::string& bytes, telemetry::WireType type, const std::string& word) {
    using telemetry::WireType;
    switch (type) {
        case WireType::text:
            bytes += word.empty() ? '\0' : word[0];
            break;
        case WireType::float32:
            append_little_endian(bytes, std::strtof(word.c_str(), nullptr));
            break;
        case WireType::float64:
            append_little_endian(bytes, std::strtod(word.c_str(), nullptr));
            break;
        case WireType::uint64:
            append_little_endian(bytes, std::uint64_t{std::strtoull(word.c_str(), nullptr, 10)});
            break;
        default: {
            std::string whole;
            append_little_endian(whole, std::int64_t{std::strtoll(word.c_str(), nullptr, 10)});
            bytes += whole.substr(0, telemetry::size_of(type));
        }
    }
}

/// The parts between `by`; one in quotes may hold it.
inline std::vector<std::string> split(std::string_view text, char by) {
    std::vector<std::string> parts(1);
    bool is_quoted = false;
    for (const char c : text) {
        if (c == '"') is_quoted = !is_quoted;
        if (c == by && !is_quoted) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

inline void append_field(std::string& bytes, const telemetry::WireField& field, std::string word) {
    using telemetry::WireCount;
    const bool is_text = field.type == telemetry::WireType::text && field.count != WireCount::one;
    if (is_text && word.size() > 1 && word.front() == '"') word = word.substr(1, word.size() - 2);
    std::vector<std::string> elements;
    if (is_text) {
        for (const char c : word) elements.emplace_back(1, c);
    } else {
        elements = field.count == WireCount::one ? std::vector{word} : split(word, ',');
        if (word.empty()) elements.clear();
    }
    if (field.count == WireCount::counted) bytes += static_cast<char>(elements.size());
    if (field.count == WireCount::fixed) elements.resize(field.elements);
    for (const auto& element : elements) append_value(bytes, field.type, element);
}

inline const telemetry::WireMessage* message_of(const telemetry::MessageDictionary& dictionary, std::string_view name) {
    for (const auto& message : dictionary.messages())
        if (message.definition.name == name) return &message;
    return nullptr;
}

}  // namespace detail

/// Header and fields of "20 ENERGY 57 11.62 1.64", a line of a .data without its time; nothing where the message is not
/// defined or has another number of fields, or the sender is no byte (ground).
inline std::optional<std::string> binary_message(std::string_view line, const telemetry::MessageDictionary& dictionary,
                                                 LinkVersion version, const Addressing& addressing = {}) {
    auto words = detail::split(line, ' ');
    if (words.size() < 2) return std::nullopt;
    const auto* const message = detail::message_of(dictionary, words[1]);
    if (message == nullptr) return std::nullopt;
    if (message->fields.empty() && words.size() == 3 && words[2].empty()) words.pop_back();  // "PONG "
    if (words.size() != message->fields.size() + 2) return std::nullopt;
    const auto sender = parse_unsigned(words[0]);
    if (!sender || *sender > 0xFF) return std::nullopt;
    std::string bytes(1, static_cast<char>(*sender));
    if (version == LinkVersion::v2) {
        bytes += static_cast<char>(addressing.destination);
        bytes += static_cast<char>(message->class_id | addressing.component << 4);
    }
    bytes += static_cast<char>(message->id);
    for (std::size_t i = 0; i < message->fields.size(); ++i)
        detail::append_field(bytes, message->fields[i], words[i + 2]);
    return bytes;
}

inline std::string card_frame(std::string_view message, std::uint32_t time_100us, std::uint8_t source = 0) {
    std::string frame{'\x99', static_cast<char>(message.size()), static_cast<char>(source)};
    detail::append_little_endian(frame, time_100us);
    frame += message;
    std::uint8_t sum = 0;
    for (const char c : frame.substr(1)) sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(c));
    return frame + static_cast<char>(sum);
}

inline std::string link_frame(std::string_view message) {
    std::string frame{'\x99', static_cast<char>(message.size() + 4)};
    frame += message;
    std::uint8_t a = 0;
    std::uint8_t b = 0;
    for (const char c : frame.substr(1)) {
        a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
        b = static_cast<std::uint8_t>(b + a);
    }
    return frame + static_cast<char>(a) + static_cast<char>(b);
}

/// `kind`: 0x80, 0x81 or 0x90. `escaped`: API mode 2.
inline std::string xbee_frame(std::string_view message, std::uint8_t kind = 0x81, bool escaped = false) {
    std::string packet(1, static_cast<char>(kind));
    packet += std::string(kind == 0x81 ? 4 : kind == 0x80 ? 10 : 11, '\x13');
    packet += message;
    std::uint8_t sum = 0;
    for (const char c : packet) sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(c));
    std::string rest{static_cast<char>(packet.size() >> 8), static_cast<char>(packet.size() & 0xFF)};
    rest += packet + static_cast<char>(0xFF - sum);
    std::string frame(1, '\x7E');
    for (const char c : rest) {
        const bool special = c == '\x7E' || c == '\x7D' || c == '\x11' || c == '\x13';
        if (escaped && special) frame += '\x7D';
        frame += escaped && special ? static_cast<char>(c ^ 0x20) : c;
    }
    return frame;
}

/// The lines of a .data whose messages are defined, as an SD card's log.
inline std::string card_log(std::string_view data, const telemetry::MessageDictionary& dictionary,
                            LinkVersion version) {
    std::string log;
    while (!data.empty()) {
        const std::string line(data.substr(0, data.find('\n')));
        data.remove_prefix(std::min(line.size() + 1, data.size()));
        const auto blank = line.find(' ');
        if (blank == std::string::npos) continue;
        const auto message = binary_message(std::string_view(line).substr(blank + 1), dictionary, version);
        if (!message) continue;
        log += card_frame(*message, static_cast<std::uint32_t>(std::llround(std::strtod(line.c_str(), nullptr) * 1e4)));
    }
    return log;
}

}  // namespace flightwatt::test
