#pragma once

#include "telemetry/mavlink/frames.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace flightwatt::telemetry {

/// Size of the time before a packet in a .tlog.
inline constexpr std::size_t tlog_time_bytes = 8;

/// A packet in a .tlog, with its time of reception.
struct TlogEntry {
    std::uint64_t time_us = 0;  ///< Unix time
    MavlinkFrame frame;
};

/// Returns the time of reception that an entry of at least 8 bytes begins with, big-endian [us].
std::uint64_t tlog_time_us(std::string_view bytes);

/// Returns whether the bytes may begin an entry: they have a time between 2001 and 2100 and the header of a packet, or
/// end within them.
bool may_be_tlog_entry(std::string_view bytes);

/// Returns the entry that the bytes begin with; std::nullopt if none does. A packet of an unknown message has no checksum
/// that could be checked: another must follow it, or the end.
std::optional<TlogEntry> read_tlog_entry(std::string_view bytes);

}  // namespace flightwatt::telemetry
