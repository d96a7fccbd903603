#pragma once

#include "telemetry/binary/wire_value.h"
#include "telemetry/message_dictionary.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

/// Detection and parsing of single frames by their checksums (docs/formats.md, "Binary logs and links").
namespace flightwatt::telemetry {

/// Returns the framing whose consecutive frames with valid checksums fill most of the bytes, if there is one. If
/// `is_whole`, no more bytes follow, and a single frame that fills them is enough.
std::optional<Framing> detect_framing(std::string_view bytes, bool is_whole);

/// Returns the header version that matches most of the first few thousand frames; std::nullopt if neither does.
std::optional<LinkVersion> detect_version(std::string_view bytes, Framing framing, const MessageDictionary& dictionary);

/// Calls use.template operator()<framing>() and returns its result.
template <typename Use>
auto with_framing(Framing framing, Use&& use) {
    switch (framing) {
        case Framing::card:
            return use.template operator()<Framing::card>();
        case Framing::link:
            return use.template operator()<Framing::link>();
        case Framing::xbee:
            break;
    }
    return use.template operator()<Framing::xbee>();
}

/// A frame with a valid checksum.
struct Frame {
    std::size_t size = 0;               ///< bytes of the whole frame
    std::string_view message;           ///< header and fields; empty where it carries none
    std::uint8_t source = 0;            ///< in card frames: 0 telemetry, 1 datalink
    std::uint32_t time_100us = 0;       ///< in card frames: time in units of 0.1 ms
    std::array<char, 320> unescaped{};  ///< memory of `message` if the frame was escaped
};

/// Result of parsing a frame at a position.
enum class ParseStatus {
    none,        ///< no frame begins here
    incomplete,  ///< a frame may begin here, but there are too few bytes
    frame,
};

/// Returns the byte at `p` as a number.
inline std::uint8_t byte_at(const char* p) { return static_cast<std::uint8_t>(*p); }

/// Returns the first byte of a frame.
constexpr char sync_byte(Framing framing) { return framing == Framing::xbee ? '\x7E' : '\x99'; }

/// Returns the number of bytes after the message at the end of a frame.
constexpr std::ptrdiff_t checksum_bytes(Framing framing) { return framing == Framing::link ? 2 : 1; }

/// Returns whether sync bytes and length at `p` indicate two consecutive frames. False for XBees, whose lengths may be
/// escaped.
template <Framing framing>
bool looks_like_two_frames(const char* p, const char* end) {
    if (framing == Framing::xbee || end - p < 2 || *p != sync_byte(framing)) return false;
    const std::ptrdiff_t size = byte_at(p + 1) + (framing == Framing::card ? 8 : 0);
    return size < end - p && p[size] == sync_byte(framing);
}

/// Parses a frame of an SD card's log at `p`: sync byte, length, source, time, message, checksum.
inline ParseStatus parse_card_frame(const char* p, const char* end, Frame& frame) {
    constexpr std::size_t overhead = 8;
    if (end - p < 2) return ParseStatus::incomplete;
    const std::size_t length = byte_at(p + 1);
    if (length < 2) return ParseStatus::none;
    const auto size = length + overhead;
    if (static_cast<std::size_t>(end - p) < size) return ParseStatus::incomplete;
    std::uint8_t sum = 0;
    for (const char* at = p + 1; at < p + size - 1; ++at) sum = static_cast<std::uint8_t>(sum + byte_at(at));
    if (sum != byte_at(p + size - 1)) return ParseStatus::none;
    frame.size = size;
    frame.message = {p + 7, length};
    frame.source = byte_at(p + 2);
    frame.time_100us = wire_number<std::uint32_t>(p + 3);
    return ParseStatus::frame;
}

/// Parses a frame of a link at `p`: sync byte, length, message, two checksums.
inline ParseStatus parse_link_frame(const char* p, const char* end, Frame& frame) {
    constexpr std::size_t overhead = 4;
    if (end - p < 2) return ParseStatus::incomplete;
    const std::size_t size = byte_at(p + 1);
    if (size < overhead + 2) return ParseStatus::none;
    if (static_cast<std::size_t>(end - p) < size) return ParseStatus::incomplete;
    std::uint8_t a = 0;
    std::uint8_t b = 0;
    for (const char* at = p + 1; at < p + size - 2; ++at) {
        a = static_cast<std::uint8_t>(a + byte_at(at));
        b = static_cast<std::uint8_t>(b + a);
    }
    if (a != byte_at(p + size - 2) || b != byte_at(p + size - 1)) return ParseStatus::none;
    frame.size = size;
    frame.message = {p + 2, size - overhead};
    frame.source = 0;
    return ParseStatus::frame;
}

/// Parses a packet received by an XBee at `p`. If `escaped` (API mode 2), 0x7E, 0x7D, 0x11 and 0x13 are sent as 0x7D
/// and the byte with bit 5 inverted.
ParseStatus parse_xbee_frame(const char* p, const char* end, bool escaped, Frame& frame);

/// Parses an unescaped or escaped packet of an XBee: if both have a valid checksum, the one that another frame follows;
/// if both are followed, the shorter.
ParseStatus parse_any_xbee_frame(const char* p, const char* end, Frame& frame);

/// Parses the frame that begins with the sync byte at `p`.
template <Framing framing>
ParseStatus parse_frame(const char* p, const char* end, Frame& frame) {
    if constexpr (framing == Framing::card) return parse_card_frame(p, end, frame);
    if constexpr (framing == Framing::link) return parse_link_frame(p, end, frame);
    return parse_any_xbee_frame(p, end, frame);
}

/// An accepted frame, and its message by the definitions.
struct FoundFrame {
    std::size_t offset = 0;  ///< position of its first byte, from the first scanned byte
    std::uint8_t sender = 0;
    std::uint8_t class_id = 0;
    std::uint8_t id = 0;
    bool carries_message = false;
    std::string_view fields;
    const WireMessage* message = nullptr;  ///< nullptr: not defined
    bool length_matches = false;           ///< the fields have the defined length
};

/// Reads the header of a frame's message and finds its definition; no message if there are too few bytes for the
/// header.
inline FoundFrame read_message_header(const Frame& frame, LinkVersion version, const MessageDictionary& dictionary) {
    FoundFrame found;
    const auto& bytes = frame.message;
    const std::size_t header = version == LinkVersion::v1 ? 2 : 4;
    if (bytes.size() < header) return found;
    found.carries_message = true;
    found.sender = byte_at(bytes.data());
    if (version == LinkVersion::v1) {
        found.class_id = frame.source == 1 ? MessageDictionary::datalink_class : MessageDictionary::telemetry_class;
    } else {
        found.class_id = byte_at(bytes.data() + 2) & 0xF;  // the high bits are the component
    }
    found.id = byte_at(bytes.data() + header - 1);
    found.fields = {bytes.data() + header, bytes.size() - header};
    found.message = dictionary.find(found.class_id, found.id);
    found.length_matches = found.message != nullptr && found.message->fits(found.fields);
    return found;
}

}  // namespace flightwatt::telemetry
