#pragma once

#include "telemetry/autopilot/row_collector.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A message of MAVLink: its fields with their places in the payload, an element of an array as "voltages[3]".
struct MavlinkMessage {
    std::uint32_t id = 0;
    LoggedMessage layout = {};   ///< `bytes` counts the extensions too
    std::size_t base_bytes = 0;  ///< size of the payload without extensions, as version 1 sends it
    std::uint8_t crc_extra = 0;  ///< seed that the checksum of every such message ends with
};

/// Returns the messages that FlightWatt reads or writes, by rising id (common.xml, ardupilotmega.xml of MAVLink).
const std::vector<MavlinkMessage>& mavlink_messages();

/// Returns the message of an id; nullptr if FlightWatt does not know it.
const MavlinkMessage* find_mavlink_message(std::uint32_t id);

/// Returns the message of a name, which must be one of mavlink_messages().
const MavlinkMessage& mavlink_message(std::string_view name);

/// Returns MAVLink's checksum of bytes and the seed behind them: CRC-16/MCRF4XX.
std::uint16_t mavlink_checksum(std::string_view bytes, std::optional<std::uint8_t> crc_extra);

}  // namespace flightwatt::telemetry
