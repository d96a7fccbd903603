#pragma once

#include "live/sources/ivy_agent.h"
#include "live/sources/line_buffer.h"
#include "live/sources/perl_regexp.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

namespace flightwatt::live {

/// The connection of an IvyAgent with another agent.
class IvyPeer : public std::enable_shared_from_this<IvyPeer> {
  public:
    IvyPeer(IvyAgent& agent, boost::asio::ip::tcp::socket socket);

    boost::asio::ip::tcp::socket& socket() { return socket_; }

    /// Connects to an agent that was announced.
    void connect(const boost::asio::ip::tcp::endpoint& to, std::string announced_id);
    /// The connection stands: says what we subscribe to, and listens.
    void begin();
    void send(std::string_view message);
    /// This connection is one too many: no message is sent on it any more. It stays until the other end has said
    /// good-bye, too, so that what either has sent before still arrives.
    void retire();
    /// With a good-bye where there is somebody to hear it.
    void close();

    /// Whether this is the connection with the agent that takes connections there.
    bool is_connected_to(const boost::asio::ip::address& address, std::uint16_t service_port) const;
    const std::string& announced_id() const { return announced_id_; }
    bool ready() const { return ready_; }
    std::size_t waiting_bytes() const { return outgoing_.size() + writing_.size(); }
    std::uint16_t service_port() const { return service_port_; }
    const boost::asio::ip::address& address() const { return address_; }
    /// The same number at both ends: of two connections between two agents, the one of the higher is retired.
    std::uint16_t higher_port() const;

  private:
    void listen();
    void handle_line(const std::string& line);
    void heed(const IvyLine& line);
    void subscribe(const IvyLine& line);
    void write(std::string_view text);
    void write_next();
    void lose();

    IvyAgent& agent_;
    boost::asio::ip::tcp::socket socket_;
    boost::asio::ip::address address_;
    std::string announced_id_;
    std::uint16_t service_port_ = 0;  ///< 0: not known yet
    bool begun_ = false, ready_ = false, retired_ = false, other_said_bye_ = false, closed_ = false;
    std::array<char, 16'384> received_{};
    LineBuffer buffer_;
    std::size_t overlong_ = 0;
    std::vector<std::string> lines_;
    std::map<int, PerlRegexp> subscriptions_;
    std::string outgoing_, writing_;
};

}  // namespace flightwatt::live
