// Frames of MAVLink alone: as a link, as a growing .tlog and as a .tlog, with every field of every message. A target of its
// own, as mavlink, which reads a flight of them, is much slower.

#include "fuzz/fuzz_target.h"
#include "fuzz/mavlink_checksums.h"
#include "telemetry/mavlink/tlog.h"
#include "telemetry/mavlink_decoder.h"

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace flightwatt;

/// All fields of two messages, one of them with an array: setting up more takes longer than reading. The other messages
/// are read by read_mavlink_packet.
const std::vector<telemetry::MessageRequest>& wanted() {
    static const auto all = [] {
        std::vector<telemetry::MessageRequest> requests;
        for (const auto* name : {"SYS_STATUS", "BATTERY_STATUS"}) {
            requests.push_back({name, {}});
            for (const auto& field : telemetry::mavlink_message(name).layout.fields)
                requests.back().fields.push_back(field.name);
        }
        return requests;
    }();
    return all;
}

/// Values are of known messages, and no byte counts both as a packet's and as skipped.
void decode(std::string_view bytes, bool is_tlog) {
    telemetry::MavlinkDecoder decoder(std::make_shared<telemetry::MavlinkVehicles>(wanted()), is_tlog);
    std::size_t packet_bytes = 0;
    const auto check = [&](const telemetry::MavlinkMessageOfVehicle& message) {
        packet_bytes += message.packet.size();
        const bool is_known = telemetry::read_mavlink_packet(message.packet).has_value();
        if (!is_known && !message.values.empty()) std::abort();
    };
    for (std::size_t at = 0; at < bytes.size(); at += 100) decoder.push(bytes.substr(at, 100), check);
    if (packet_bytes + decoder.skipped_bytes() > bytes.size()) std::abort();
}

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto repaired = with_mavlink_checksums(std::string(bytes));
    decode(bytes, false);
    decode(repaired, true);
    telemetry::read_tlog(repaired, "fuzz.tlog", wanted());
}
