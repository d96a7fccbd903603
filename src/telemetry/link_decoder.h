#pragma once

#include "telemetry/message_dictionary.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace flightwatt::telemetry {

/// One message that came in.
struct LinkMessage {
    std::uint8_t sender = 0;
    std::uint8_t class_id = MessageDictionary::telemetry_class;
    std::string_view name;
    std::optional<double> time_s;         ///< of card frames, and of links with TIMESTAMP messages between
    std::string_view text;                ///< a .data line without its time and line break: "20 ENERGY 57 11.62 1.64"
    std::span<const double> values = {};  ///< of its fields; NaN for what is no single finite number
};

/// What a decoder saw. Each byte is one of a frame, skipped, zero or pending.
struct LinkCounts {
    std::size_t bytes = 0;               ///< pushed
    std::size_t frames = 0;              ///< with the right checksum
    std::size_t messages = 0;            ///< of them decoded
    std::size_t unknown = 0;             ///< of a message that is not defined
    std::size_t length_mismatches = 0;   ///< of a message that is defined with another length
    std::size_t non_message_frames = 0;  ///< that carry no message: an XBee's status
    std::size_t skipped_bytes = 0;       ///< between frames: damage
    std::size_t skipped_runs = 0;        ///< how often
    std::size_t padding_bytes = 0;       ///< zeros alone between frames or at the end: room set aside
    std::optional<LinkVersion> version;  ///< nothing: none decided yet
    std::optional<Framing> framing;
    /// Frames that are unknown or of other lengths, by 256 * class + id.
    std::map<std::uint16_t, std::size_t> unknown_ids = {};
    std::map<std::uint16_t, std::size_t> other_length_ids = {};
};

/// Messages out of bytes as they arrive, in pieces of any size. Damage and garbage are skipped and counted and never
/// end it; memory is constant, and nothing is allocated after the first message of each length. A message is handed out
/// with the last byte of its frame.
class LinkDecoder {
  public:
    using Sink = std::function<void(const LinkMessage&)>;

    /// Framing and version are told by content where they are not given: the first frames then wait until some have
    /// followed each other (see flush).
    explicit LinkDecoder(MessageDictionary dictionary, std::optional<Framing> framing = std::nullopt,
                         std::optional<LinkVersion> version = std::nullopt);
    ~LinkDecoder();
    LinkDecoder(LinkDecoder&&) noexcept;
    LinkDecoder& operator=(LinkDecoder&&) noexcept;

    /// Calls `sink` for each message that is now whole; what it is given is valid during the call alone.
    void push(std::string_view bytes, const Sink& sink);
    /// The bytes end here: a file's end, a link that is reopened. What waits is decided.
    void flush(const Sink& sink);
    const LinkCounts& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace flightwatt::telemetry
