#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Decoding of MAVLink as it is received, and packets to send.
namespace flightwatt::telemetry {

struct MavlinkFrame;

/// A message of a vehicle's autopilot or of its smart battery.
struct MavlinkMessageOfVehicle {
    std::string_view sender;         ///< number of the system: "1"
    std::string_view name;           ///< "SYS_STATUS"; "MESSAGE_12345" of one that FlightWatt does not know
    std::span<const double> values;  ///< of the requested fields, in their order; empty if it is not requested
    std::string_view packet;         ///< its bytes
    std::optional<double> unix_s;    ///< time of reception, where a ground station recorded it (.tlog)
};

/// Knows the vehicles of a link by their heartbeats, and which messages came before, over all radios that carry them.
class MavlinkVehicles {
  public:
    /// Reads these messages and fields.
    explicit MavlinkVehicles(const std::vector<MessageRequest>& wanted);
    ~MavlinkVehicles();
    /// Returns the number of packets that got lost on the link since the last call.
    std::size_t take_lost();
    /// Returns whether that number is more than a link loses, as two senders have one id, or one is heard twice.
    bool alternates() const;

  private:
    friend class MavlinkDecoder;
    struct State;
    std::unique_ptr<State> state_;
};

/// Decodes a stream of MAVLink 1 and 2, as bytes of a link or as a growing .tlog. Messages of ground stations, cameras and
/// companion computers are passed over, and those before a vehicle's first heartbeat.
class MavlinkDecoder {
  public:
    using OnMessage = std::function<void(const MavlinkMessageOfVehicle&)>;

    MavlinkDecoder(std::shared_ptr<MavlinkVehicles> vehicles, bool is_tlog);
    /// Decodes further bytes.
    void push(std::string_view bytes, const OnMessage& on_message);
    /// Begins another stream.
    void restart();
    /// Returns the number of bytes that are no packet.
    std::size_t skipped_bytes() const { return skipped_bytes_; }

  private:
    bool may_follow(std::string_view bytes) const;
    void forward(const MavlinkFrame& frame, std::string_view entry, const OnMessage& on_message);

    std::shared_ptr<MavlinkVehicles> vehicles_;
    bool is_tlog_;
    std::string waiting_;
    std::size_t skipped_bytes_ = 0;
};

/// A packet of a message that FlightWatt knows.
struct MavlinkPacket {
    std::string name;         ///< of the message
    std::uint8_t system = 0;  ///< of the sender
    std::uint8_t component = 0;
    std::map<std::string, double, std::less<>> of;  ///< the fields by their names; NaN for those that it does not have
    std::string text = {};                          ///< its field of characters
};

/// Returns the packet that the bytes are; std::nullopt for other bytes, and for a message that FlightWatt does not know.
std::optional<MavlinkPacket> read_mavlink_packet(std::string_view bytes);

/// Returns an entry of a .tlog: the Unix time of reception and the packet.
std::string tlog_entry(double unix_s, std::string_view packet);

}  // namespace flightwatt::telemetry
