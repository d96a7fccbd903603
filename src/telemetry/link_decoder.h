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

/// A received message.
struct LinkMessage {
    std::uint8_t sender = 0;
    std::uint8_t class_id = MessageDictionary::telemetry_class;
    std::string_view name;
    std::optional<double> time_s;         ///< in card frames, and on links with TIMESTAMP messages
    std::string_view text;                ///< a .data line without its time and line break: "20 ENERGY 57 11.62 1.64"
    std::span<const double> values = {};  ///< of the fields; NaN for text, arrays, non-finite values
};

/// Counters of a decoder. Each byte belongs to a frame, or is skipped, zero or pending.
struct LinkCounts {
    std::size_t bytes = 0;               ///< received
    std::size_t frames = 0;              ///< with a valid checksum
    std::size_t messages = 0;            ///< decoded from them
    std::size_t unknown = 0;             ///< frames of undefined messages
    std::size_t length_mismatches = 0;   ///< frames of messages defined with another length
    std::size_t non_message_frames = 0;  ///< without a message: an XBee's status
    std::size_t skipped_bytes = 0;       ///< between frames: damage
    std::size_t skipped_runs = 0;        ///< number of such places
    std::size_t padding_bytes = 0;       ///< zeros between frames or at the end: preallocated space
    std::optional<LinkVersion> version;  ///< std::nullopt: not decided yet
    std::optional<Framing> framing;
    /// Number of unknown frames, and below of frames of other lengths, by 256 * class + id.
    std::map<std::uint16_t, std::size_t> unknown_ids = {};
    std::map<std::uint16_t, std::size_t> other_length_ids = {};
};

/// Decodes messages from bytes that arrive in chunks of any size. Damage is skipped and counted; memory is constant,
/// and nothing is allocated after the first message of each length. A message is delivered with the last byte of its
/// frame.
class LinkDecoder {
  public:
    using Sink = std::function<void(const LinkMessage&)>;

    /// Decodes by the definitions of `dictionary`. Without framing or version these are detected: the first frames are
    /// then delayed until a few have followed each other (see flush).
    explicit LinkDecoder(MessageDictionary dictionary, std::optional<Framing> framing = std::nullopt,
                         std::optional<LinkVersion> version = std::nullopt);
    ~LinkDecoder();
    LinkDecoder(LinkDecoder&&) noexcept;
    LinkDecoder& operator=(LinkDecoder&&) noexcept;

    /// Calls `sink` for each complete message; its argument is valid only during the call.
    void push(std::string_view bytes, const Sink& sink);
    /// Ends the input (a file's end, a reopened link): delivers or discards the pending bytes.
    void flush(const Sink& sink);
    /// Returns the counters since the start.
    const LinkCounts& counts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace flightwatt::telemetry
