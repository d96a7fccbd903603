#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// An Ivy bus: where its agents announce themselves.
struct IvyBus {
    std::vector<std::string> networks;  ///< broadcast or multicast addresses, dotted
    std::uint16_t port = 2010;

    /// All networks are of this machine alone (127...): nobody else is listened to.
    bool is_local() const;
};

/// "127.255.255.255:2010", as Ivy's libraries read it: addresses by commas, what they lack is 255 ("127:2010"), and one
/// part may be left out. Throws UsageError.
IvyBus parse_ivy_bus(std::string_view text);

/// What an agent says to all when it starts: "3 PORT ID NAME\n".
struct IvyAnnouncement {
    std::uint16_t port = 0;  ///< where it takes connections
    std::string id;          ///< another at each start; may be empty, as the name
    std::string name;
};

inline constexpr int ivy_version = 3;

std::string to_datagram(const IvyAnnouncement& announcement);
/// std::nullopt: none, or of another version of the protocol.
std::optional<IvyAnnouncement> parse_announcement(std::string_view datagram);

/// What lines between two agents say. Others are let pass.
enum class IvyType {
    bye = 0,
    subscribe = 1,
    message = 2,
    error = 3,
    unsubscribe = 4,
    end_of_subscriptions = 5,
    start = 6,  ///< with the port where the agent takes connections, and its name
    direct = 7,
    die = 8,
    ping = 9,
    pong = 10,
};

/// "TYPE ID \002 ARGUMENTS", without the line break.
struct IvyLine {
    int type = 0;
    int id = 0;
    std::string_view arguments;  ///< of the line that was parsed
};

std::optional<IvyLine> parse_ivy_line(std::string_view line);
/// With its line break. Breaks in `arguments` become blanks.
std::string to_ivy_line(IvyType type, int id, std::string_view arguments = {});

/// The groups of a message's arguments, each ended by \003.
std::vector<std::string_view> groups_of(std::string_view arguments);

}  // namespace flightwatt::live
