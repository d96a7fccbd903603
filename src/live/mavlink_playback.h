#pragma once

#include "flight/flight_data.h"
#include "live/playback.h"
#include "live/sources.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Playing a log of any kind as MAVLink.
namespace flightwatt::live {

/// Returns the packets that an aircraft with these tracks would send, by rising time: a heartbeat and SYS_STATUS once a
/// second, BATTERY_STATUS at each power, GLOBAL_POSITION_INT and VFR_HUD at each altitude, with the values that are known
/// then. Throws InputError without measured power and voltage.
std::vector<IncomingMessage> mavlink_messages_of(const flight::FlightData& data);

/// Returns a target that sends the packets of messages, one in each datagram, to an address: "127.0.0.1:14550". Throws
/// UsageError for another text.
PlaybackTarget open_mavlink_target(std::string_view to);

/// Plays a log as MAVLink, as play() does: the packets of a .tlog, of other logs those of mavlink_messages_of(). Of
/// several aircraft `aircraft` names one. Throws InputError for a log that cannot be read.
PlaybackReport play_as_mavlink(const std::filesystem::path& log, double speed, const PlaybackTarget& target,
                               const std::function<bool()>& stop, const std::optional<std::string>& aircraft = {});

}  // namespace flightwatt::live
