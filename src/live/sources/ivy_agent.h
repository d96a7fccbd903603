#pragma once

#include "live/sources/ivy_protocol.h"

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>

namespace flightwatt::live {

/// Bus, name, subscriptions and handlers of an agent.
struct IvyAgentSetup {
    boost::asio::ip::udp::endpoint bus;
    std::string name;
    std::vector<std::string> subscriptions = {};  ///< regular expressions; their ids count from 0

    /// Called with the groups of a message from another agent.
    std::function<void(const std::vector<std::string_view>&)> on_message = [](const auto&) {};
    /// Called for each unusable line.
    std::function<void(std::string_view reason)> on_unusable = [](std::string_view) {};
    /// Called when another agent has left.
    std::function<void()> on_peer_lost = [] {};
};

/// An agent that listens on an Ivy bus: announces itself, connects once with each other agent, sends its subscriptions
/// and answers pings. Malformed lines and requests to end are counted and ignored. Runs in the
/// thread that runs the context.
class IvyAgent {
  public:
    /// Opens its sockets and starts. Throws InputError, as where another program uses the port exclusively.
    IvyAgent(boost::asio::io_context& context, IvyAgentSetup setup);
    /// Sends a bye and closes all connections; the context does not run.
    ~IvyAgent();

  private:
    class Peer;

    boost::asio::awaitable<void> announce_while_alone();
    boost::asio::awaitable<void> listen_for_announcements();
    void announce();
    void handle_announcement(const IvyAnnouncement& announcement, const boost::asio::ip::address& from);
    void add_peer(const std::shared_ptr<Peer>& peer);
    void retire_duplicate(Peer& peer);
    bool is_local() const { return setup_.bus.address().is_loopback(); }

    boost::asio::io_context& context_;
    IvyAgentSetup setup_;
    boost::asio::ip::udp::socket bus_socket_;
    boost::asio::ip::tcp::acceptor acceptor_;
    std::uint16_t port_ = 0;
    std::string id_;
    std::list<std::shared_ptr<Peer>> peers_;
};

}  // namespace flightwatt::live
