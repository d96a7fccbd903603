#pragma once

#include "telemetry/mavlink/messages.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::telemetry {

/// A packet of MAVLink 1 or 2. Version 2 leaves out zeros at the end of the payload and version 1 extensions: the
/// former are restored, the latter are not there.
struct MavlinkFrame {
    std::uint8_t system = 0;
    std::uint8_t component = 0;
    std::uint8_t sequence = 0;
    std::uint32_t id = 0;
    const MavlinkMessage* message = nullptr;  ///< nullptr: unknown, whose checksum cannot be checked
    std::string payload = {};
    std::size_t bytes = 0;  ///< size of the packet, with its signature
    std::uint16_t checksum = 0;

    /// Returns a field as a number, NaN if the payload ends before it; the message must be known and have the field.
    double number(std::string_view field) const;
    /// Returns a field of characters up to the first zero; the message must be known and have the field.
    std::string text(std::string_view field) const;
};

/// Returns the size of the packet whose header the bytes begin with, which may exceed that of the bytes; 0 if no header
/// is there or it needs an unknown feature; std::nullopt if the bytes end within the header.
std::optional<std::size_t> mavlink_frame_bytes(std::string_view bytes);

/// Returns the packet that the bytes begin with; std::nullopt if none does, or its checksum is wrong.
std::optional<MavlinkFrame> read_mavlink_frame(std::string_view bytes);

/// Counts the packets of each component that got lost, by the gaps of their sequence numbers. The same packet by a
/// second radio is a copy, and one out of order is not lost.
class MavlinkSequence {
  public:
    /// Counts a packet. Returns false for a copy of one of the last 96 of its component.
    bool add(const MavlinkFrame& frame);
    std::size_t received() const { return received_; }
    std::size_t lost() const { return lost_; }
    /// Returns whether more is missing than a link loses: the numbers of two senders with one id, or of one that is
    /// heard twice, by seconds apart, alternate.
    bool alternates() const { return received_ > 100 && lost_ > 5 * received_; }

  private:
    struct Last {
        std::uint8_t sequence = 0;
        std::vector<std::pair<std::uint8_t, std::uint16_t>> recent = {};  ///< sequence numbers and checksums
        std::size_t next = 0;
    };

    std::map<std::uint16_t, Last> components_;
    std::size_t received_ = 0;
    std::size_t lost_ = 0;
};

}  // namespace flightwatt::telemetry
