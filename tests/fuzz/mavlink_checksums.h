#pragma once

#include "telemetry/mavlink/frames.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace flightwatt::fuzz {

/// Returns the bytes with right checksums of the packets of known messages, which random bytes would not have.
inline std::string with_mavlink_checksums(std::string bytes) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        const auto rest = std::string_view(bytes).substr(at);
        const auto size = telemetry::mavlink_frame_bytes(rest).value_or(0);
        if (size == 0 || size > rest.size()) continue;
        const bool is_v2 = byte(at) == 0xFD;
        const std::size_t header = is_v2 ? 10 : 6;
        const std::uint32_t id = is_v2 ? byte(at + 7) | byte(at + 8) << 8U | byte(at + 9) << 16U : byte(at + 5);
        const auto* message = telemetry::find_mavlink_message(id);
        if (message == nullptr) continue;
        const auto checked = header + byte(at + 1);
        const auto crc = telemetry::mavlink_checksum(rest.substr(1, checked - 1), message->crc_extra);
        bytes[at + checked] = static_cast<char>(crc & 0xFFU);
        bytes[at + checked + 1] = static_cast<char>(crc >> 8U);
        at += size - 1;
    }
    return bytes;
}

}  // namespace flightwatt::fuzz
