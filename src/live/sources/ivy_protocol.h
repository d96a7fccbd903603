#pragma once

#include "live/sources/message_readers.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/udp.hpp>

namespace flightwatt::live {

/// Parses the broadcast or multicast address and port of an Ivy bus: "127.255.255.255:2010". As in Ivy's libraries,
/// missing bytes of the address are 255 ("127:2010"), and the address or the port may be omitted. Throws UsageError.
boost::asio::ip::udp::endpoint parse_ivy_bus(std::string_view text);

/// The datagram that an agent broadcasts when it starts: "3 PORT ID NAME\n".
struct IvyAnnouncement {
    std::uint16_t port = 0;  ///< port at which it accepts connections
    std::string id;          ///< different at each start; id and name may be empty
    std::string name;
};

/// The version of the protocol.
inline constexpr int ivy_version = 3;

/// Returns the datagram of an announcement.
std::string to_datagram(const IvyAnnouncement& announcement);
/// Parses an announcement; std::nullopt for another datagram or protocol version.
std::optional<IvyAnnouncement> parse_announcement(std::string_view datagram);

/// The types of lines between two agents.
enum class IvyType {
    bye = 0,
    subscribe = 1,
    message = 2,
    error = 3,
    unsubscribe = 4,
    end_of_subscriptions = 5,
    start = 6,  ///< with the port at which the agent accepts connections, and its name
    direct = 7,
    die = 8,
    ping = 9,
    pong = 10,
};

/// A line between two agents: "TYPE ID \002 ARGUMENTS", without the line break.
struct IvyLine {
    int type = 0;
    int id = 0;
    std::string_view arguments;  ///< refers to the parsed line
};

/// Parses a line; std::nullopt for any other text.
std::optional<IvyLine> parse_ivy_line(std::string_view line);
/// Returns a line with its line break. Breaks in `arguments` become blanks.
std::string to_ivy_line(IvyType type, int id, std::string_view arguments = {});

/// Returns the groups of a message's arguments, each of which ends with \003.
std::vector<std::string_view> split_groups(std::string_view arguments);

/// Reads telemetry from the texts on an Ivy bus. Messages of an aircraft have no time and are forwarded at once.
/// Paparazzi's log player sends "replay20 ENERGY ...", then "time20 13.9": the message is forwarded with that time.
/// While an aircraft itself is on the bus, replays are ignored.
class IvyMessages {
  public:
    explicit IvyMessages(MessageSink& sink) : sink_(sink) {}

    /// Forwards the message in a text, if it has one.
    void handle(std::string_view text);

  private:
    MessageSink& sink_;
    std::vector<std::string> waiting_;     ///< messages of replays, for the next time
    std::optional<double> latest_time_s_;  ///< latest time of any replay
    bool has_aircraft_ = false;            ///< an aircraft itself is on the bus
};

}  // namespace flightwatt::live
