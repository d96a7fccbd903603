#pragma once

#include "telemetry/message_definition.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// How messages are packed into bytes (docs/formats.md, "Binary logs and links").
enum class Framing {
    card,  ///< frames of SD cards, with the time of each message: .LOG, .tlm
    link,  ///< frames of serial lines and UDP, without times
    xbee,  ///< received packets of an XBee's API mode, escaped or not
};

/// The header of a message: sender and id (v1), or sender, destination, class and component, id (v2).
enum class LinkVersion { v1 = 1, v2 = 2 };

/// Returns the name of a framing.
std::string_view to_string(Framing framing);
/// Returns the name of a header version.
std::string_view to_string(LinkVersion version);

/// Type of a field, or of an array's elements, on the wire: little endian, unaligned.
enum class WireType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, text };

/// Returns the type of a name in C ("uint8_t", "float", "char"); std::nullopt for other names.
std::optional<WireType> wire_type_of(std::string_view name);

/// Kind of a field's number of elements.
enum class WireCount : std::uint8_t {
    one,      ///< a scalar
    fixed,    ///< T[n]: n of them
    counted,  ///< T[] and string: a uint8 with their number precedes them
};

/// One field of a message on the wire.
struct WireField {
    WireType type = WireType::uint8;
    WireCount count = WireCount::one;
    std::uint16_t elements = 1;  ///< number of elements of `one` and `fixed`
};

/// Calls use.template operator()<T>() with the C++ type of an element (char for text) and returns its result.
template <typename Use>
auto with_wire_type(WireType type, Use&& use) {
    switch (type) {
        case WireType::int8:
            return use.template operator()<std::int8_t>();
        case WireType::uint8:
            return use.template operator()<std::uint8_t>();
        case WireType::int16:
            return use.template operator()<std::int16_t>();
        case WireType::uint16:
            return use.template operator()<std::uint16_t>();
        case WireType::int32:
            return use.template operator()<std::int32_t>();
        case WireType::uint32:
            return use.template operator()<std::uint32_t>();
        case WireType::int64:
            return use.template operator()<std::int64_t>();
        case WireType::uint64:
            return use.template operator()<std::uint64_t>();
        case WireType::float32:
            return use.template operator()<float>();
        case WireType::float64:
            return use.template operator()<double>();
        case WireType::text:
            break;
    }
    return use.template operator()<char>();
}

/// Returns the size of one element in bytes.
inline std::size_t size_of(WireType type) {
    return with_wire_type(type, []<typename T>() { return sizeof(T); });
}

/// A message in frames, identified by the number of its class and its own.
struct WireMessage {
    MessageDefinition definition;
    std::uint8_t class_id = 0;
    std::uint8_t id = 0;
    std::vector<WireField> fields;  ///< one for each of definition.fields

    std::size_t fixed_bytes = 0;  ///< size of the fields that are not `counted`
    bool has_counted = false;

    /// Returns whether the fields fill the payload exactly.
    bool fits(std::string_view payload) const {
        return has_counted ? fits_counted(payload) : payload.size() == fixed_bytes;
    }

  private:
    bool fits_counted(std::string_view payload) const;
};

/// The messages of all classes of a <protocol>, found by the numbers in frames.
class MessageDictionary {
  public:
    static constexpr std::uint8_t telemetry_class = 1;
    static constexpr std::uint8_t datalink_class = 2;

    /// Adds a message. Ignores one whose numbers are taken or over 255, or which has a field of an unknown type.
    void add(std::string_view class_id, std::string_view class_name, std::string_view message_id,
             const MessageDefinition& definition);
    /// Returns the message of two numbers; nullptr if it is not defined.
    const WireMessage* find(std::uint8_t class_id, std::uint8_t message_id) const {
        if (class_id >= max_classes) return nullptr;
        const auto number = numbers_[std::size_t{class_id} * 256 + message_id];
        return number == 0 ? nullptr : &messages_[number - 1];
    }
    const std::vector<WireMessage>& messages() const { return messages_; }
    bool empty() const { return messages_.empty(); }

  private:
    static constexpr std::size_t max_classes = 16;

    std::vector<WireMessage> messages_;
    std::array<std::uint16_t, max_classes * 256>
        numbers_{};  ///< positions in messages_, counted from 1; 0: not defined
};

/// Reads the definitions of a messages.xml, or of the <protocol> of a .log. Throws InputError if it has none.
MessageDictionary read_message_dictionary(const std::filesystem::path& path);
/// Reads the definitions from text; `file` is named in errors.
MessageDictionary parse_message_dictionary(const std::string& text, const std::filesystem::path& file);

}  // namespace flightwatt::telemetry
