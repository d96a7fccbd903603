#pragma once

#include "telemetry/message_dictionary.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

/// Single frames of each framing, by checksum alone (docs/formats.md, "Binary logs and links").
namespace flightwatt::telemetry {

/// The framing whose frames with right checksums follow each other in most of the bytes; nothing where none does.
/// `is_unchanged`: nothing comes behind, so that a single frame is enough which fills them.
std::optional<Framing> detect_framing(std::string_view bytes, bool is_whole);

/// The header that most frames fit, of the first few thousand; nothing where none fits.
std::optional<LinkVersion> detect_version(std::string_view bytes, Framing framing, const MessageDictionary& dictionary);

/// Calls use.template operator()<framing>().
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

/// A frame whose checksum is right.
struct Frame {
    std::size_t size = 0;               ///< bytes of all of it
    std::string_view message;           ///< header and fields; empty where it carries none
    std::uint8_t source = 0;            ///< of card frames: 0 telemetry, 1 datalink
    std::uint32_t time_100us = 0;       ///< of card frames
    std::array<char, 320> unescaped{};  ///< what `message` lies in, if the frame was escaped
};

enum class ParseStatus {
    none,        ///< no frame begins here
    incomplete,  ///< one may, but there are too few bytes
    frame,
};

inline std::uint8_t byte_at(const char* p) { return static_cast<std::uint8_t>(*p); }

/// The sum of 8 to 1000 bytes, modulo 256; eight at a time.
inline std::uint8_t sum_of(const char* p, std::size_t size) {
    constexpr std::uint64_t every_other = 0x00FF00FF00FF00FFU;
    std::uint64_t sums = 0;  // four of 16 bits: of up to 128 steps of two bytes each
    const auto add = [&sums](std::uint64_t bytes) { sums += (bytes & every_other) + ((bytes >> 8) & every_other); };
    std::uint64_t bytes = 0;
    for (; size >= 8; p += 8, size -= 8) {
        std::memcpy(&bytes, p, sizeof bytes);
        add(bytes);
    }
    if (size > 0) {  // the eight bytes up to the end, less those that are not asked for
        std::memcpy(&bytes, p + size - 8, sizeof bytes);
        if constexpr (std::endian::native == std::endian::little) {
            add(bytes >> (8 * (8 - size)));
        } else {
            add(bytes & (~std::uint64_t{0} >> (8 * (8 - size))));
        }
    }
    sums += sums >> 32;
    sums += sums >> 16;
    return static_cast<std::uint8_t>(sums);
}

/// What a framing's frames begin with.
constexpr char sync_byte(Framing framing) { return framing == Framing::xbee ? '\x7E' : '\x99'; }

/// How many bytes a frame ends with that are no part of its message.
constexpr std::ptrdiff_t checksum_bytes(Framing framing) { return framing == Framing::link ? 2 : 1; }

/// Whether two frames seem to begin, by sync bytes and a length, one after the other at `p`: a quick look. Never for
/// XBees, whose lengths may be escaped.
template <Framing framing>
bool looks_like_two_frames(const char* p, const char* end) {
    if (framing == Framing::xbee || end - p < 2 || *p != sync_byte(framing)) return false;
    const std::ptrdiff_t size = byte_at(p + 1) + (framing == Framing::card ? 8 : 0);
    return size < end - p && p[size] == sync_byte(framing);
}

inline ParseStatus parse_card_frame(const char* p, const char* end, Frame& frame) {
    constexpr std::size_t overhead = 8;
    if (end - p < 2) return ParseStatus::incomplete;
    const std::size_t length = byte_at(p + 1);
    if (length < 2) return ParseStatus::none;
    const auto size = length + overhead;
    if (static_cast<std::size_t>(end - p) < size) return ParseStatus::incomplete;
    if (sum_of(p + 1, size - 2) != byte_at(p + size - 1)) return ParseStatus::none;
    frame.size = size;
    frame.message = {p + 7, length};
    frame.source = byte_at(p + 2);
    frame.time_100us = byte_at(p + 3) | std::uint32_t{byte_at(p + 4)} << 8 | std::uint32_t{byte_at(p + 5)} << 16 |
                       std::uint32_t{byte_at(p + 6)} << 24;
    return ParseStatus::frame;
}

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

/// `escaped`: XBees in API mode 2 send 0x7E, 0x7D, 0x11 and 0x13 as 0x7D and the byte with bit 5 turned.
ParseStatus parse_xbee_frame(const char* p, const char* end, bool escaped, Frame& frame);

/// As it stands, or escaped: where both have a right checksum, the one that another frame follows, and of two the
/// shorter.
ParseStatus parse_any_xbee_frame(const char* p, const char* end, Frame& frame);

/// `p` stands on a sync byte.
template <Framing framing>
ParseStatus parse_frame(const char* p, const char* end, Frame& frame) {
    if constexpr (framing == Framing::card) return parse_card_frame(p, end, frame);
    if constexpr (framing == Framing::link) return parse_link_frame(p, end, frame);
    return parse_any_xbee_frame(p, end, frame);
}

/// A frame that is taken for one that was sent, and what its message is by the definitions.
struct FoundFrame {
    std::size_t offset = 0;  ///< of its first byte, from the first that was scanned
    std::uint8_t sender = 0;
    std::uint8_t class_id = 0;
    std::uint8_t id = 0;
    bool carries_message = false;
    std::string_view fields;
    const WireMessage* message = nullptr;  ///< nullptr: not defined
    bool length_matches = false;           ///< the fields have the length that is defined
};

/// What header and fields are; without a message where there are too few bytes for the header. Of every frame, and
/// short: a call and a copy of the result would be a tenth of the time that a log takes.
[[gnu::always_inline]] inline FoundFrame read_message_header(const Frame& frame, LinkVersion version,
                                                             const MessageDictionary& dictionary) {
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
