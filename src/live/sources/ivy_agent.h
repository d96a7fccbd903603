#pragma once

#include "live/sources/ivy_protocol.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace flightwatt::live {

/// What an agent on an Ivy bus is and does.
struct IvyAgentSetup {
    IvyBus bus;
    std::string name;
    std::vector<std::string> subscriptions = {};  ///< regular expressions; their numbers count from 0
    bool sends = false;                           ///< it heeds what others subscribe to

    /// The groups of a message that another agent sent.
    std::function<void(const std::vector<std::string_view>&)> on_message = [](const auto&) {};
    /// Something came that cannot be used.
    std::function<void(std::string_view reason)> on_unusable = [](std::string_view) {};
    /// Another agent is gone.
    std::function<void()> on_peer_lost = [] {};
};

/// An agent on an Ivy bus: it announces itself and hears of others, connects with each once, says what it subscribes
/// to, and answers pings. Whatever others send, it goes on: a line that is none is counted, and a request to die is
/// (what is watched is for the one to end who started it). All in the thread that runs the context.
class IvyAgent {
  public:
    /// Opens its sockets. Throws InputError where they cannot be: another program holds the port for itself alone.
    IvyAgent(boost::asio::io_context& context, IvyAgentSetup setup);
    ~IvyAgent();

    void start();
    /// Says good-bye and closes all.
    void stop();

    /// To all whose subscriptions it matches, once for each. An agent that does not fetch what it is sent loses it.
    void send(std::string_view message);
    /// Agents that have said what they subscribe to.
    std::size_t ready_peers() const;
    /// Bytes that wait for the slowest of them.
    std::size_t waiting_bytes() const;

    const IvyAgentSetup& setup() const { return setup_; }
    std::uint16_t port() const { return port_; }

  private:
    class Peer;

    void announce();
    void announce_while_alone();
    void listen_for_announcements();
    void handle_announcement(const IvyAnnouncement& announcement, const boost::asio::ip::address& from);
    void accept();
    void accept_later();
    std::shared_ptr<Peer> add_peer(boost::asio::ip::tcp::socket socket);
    void retire_duplicate(Peer& peer);

    boost::asio::io_context& context_;
    IvyAgentSetup setup_;
    boost::asio::ip::udp::socket bus_socket_;
    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer timer_, accept_timer_;
    boost::asio::ip::udp::endpoint from_;
    std::array<char, 4096> datagram_{};
    std::uint16_t port_ = 0;
    std::string id_;
    std::list<std::shared_ptr<Peer>> peers_;
    bool stopped_ = false;
};

}  // namespace flightwatt::live
