#pragma once

#include "telemetry/telemetry_log.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// Returns whether the bytes are a recording of MAVLink by a ground station (.tlog): before each packet its Unix time
/// of reception [us], 8 bytes, big-endian. The first packets may be damaged.
bool is_tlog(std::string_view bytes);

/// Reads the requested messages of each vehicle in a .tlog, the vehicles in the order of their numbers, then of time. A
/// vehicle is a system with an autopilot, by its heartbeats; its id is the system's number, which several that are
/// flown in turn may have. Messages of ground stations, cameras and companion computers are left out. Times are seconds
/// since the first packet. Throws InputError without a vehicle.
std::vector<AutopilotLog> read_tlog(std::string_view bytes, const std::filesystem::path& file,
                                    const std::vector<MessageRequest>& wanted);

}  // namespace flightwatt::telemetry
