#include "live/sources/ivy_agent.h"

#include "base/error.h"
#include "live/sources/endpoints.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <random>
#include <utility>

#include <boost/asio.hpp>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using asio::redirect_error;
using asio::use_awaitable;
using asio::ip::tcp;
using asio::ip::udp;
using boost::system::error_code;

/// The announcement is one datagram, which may be lost: it is repeated until an agent connects. Not later: Ivy's C
/// library would connect once more.
constexpr std::chrono::seconds announce_interval{1};

/// Sets an option that Asio does not name. An agent works without it, too.
void set_option(int socket, int level, int option, int value) {
    ::setsockopt(socket, level, option, &value, sizeof(value));
}

void check(const error_code& error, const udp::endpoint& bus, const char* action) {
    if (!error) return;
    throw InputError({fmt::format("Ivy bus {}:{}", bus.address().to_string(), bus.port())},
                     fmt::format("cannot {}: {}", action, error.message()),
                     "check that the network is up and no other program uses the port exclusively");
}

void open_bus(udp::socket& socket, const udp::endpoint& bus) {
    error_code error;
    socket.open(udp::v4(), error);
    check(error, bus, "open a UDP socket");
    socket.set_option(asio::socket_base::reuse_address(true), error);
    set_option(socket.native_handle(), SOL_SOCKET, SO_REUSEPORT, 1);
    socket.set_option(asio::socket_base::broadcast(true), error);
    socket.bind({udp::v4(), bus.port()}, error);
    check(error, bus, "listen for announcements");
    if (bus.address().is_multicast()) socket.set_option(asio::ip::multicast::join_group(bus.address()), error);
    check(error, bus, "join its group");
    close_on_exec(socket);
}

/// The system detects an agent that vanished without closing the connection within a minute.
void keep_alive(tcp::socket& socket) {
    error_code ignored;
    socket.set_option(asio::socket_base::keep_alive(true), ignored);
    set_option(socket.native_handle(), IPPROTO_TCP, TCP_KEEPIDLE, 20);
    set_option(socket.native_handle(), IPPROTO_TCP, TCP_KEEPINTVL, 10);
    set_option(socket.native_handle(), IPPROTO_TCP, TCP_KEEPCNT, 3);
    socket.set_option(asio::ip::tcp::no_delay(true), ignored);
}

}  // namespace

/// The connection with another agent.
class IvyAgent::Peer : public std::enable_shared_from_this<Peer> {
  public:
    /// Of an agent that connected.
    Peer(IvyAgent& agent, tcp::socket socket) : agent_(agent), socket_(std::move(socket)) {}
    /// To an agent that was announced.
    Peer(IvyAgent& agent, const tcp::endpoint& to, std::string announced_id)
        : agent_(agent),
          socket_(agent.context_),
          address_(to.address()),
          announced_id_(std::move(announced_id)),
          service_port_(to.port()) {}

    /// Connects if necessary, sends the subscriptions, and handles lines until the connection ends (which throws).
    asio::awaitable<void> run() {
        if (!socket_.is_open()) co_await socket_.async_connect(tcp::endpoint(address_, service_port_), use_awaitable);
        address_ = socket_.remote_endpoint().address();
        begun_ = true;
        keep_alive(socket_);
        close_on_exec(socket_);
        auto hello = to_ivy_line(IvyType::start, agent_.port_, agent_.setup_.name);
        int id = 0;
        for (const auto& subscription : agent_.setup_.subscriptions)
            hello += to_ivy_line(IvyType::subscribe, id++, subscription);
        write(hello + to_ivy_line(IvyType::end_of_subscriptions, 0));
        while (!closed_) {
            const auto count = co_await socket_.async_read_some(asio::buffer(received_), use_awaitable);
            handle({received_.data(), count});
        }
    }

    /// Ends this duplicate connection. It stays open until the other end sends a bye, so that messages already sent
    /// still arrive.
    void retire() {
        retired_ = true;
        ready_ = false;
        write(to_ivy_line(IvyType::bye, 0));
    }

    /// Sends a bye if possible, and closes.
    void close() {
        if (std::exchange(closed_, true)) return;
        error_code ignored;
        if (begun_ && writing_.empty()) {
            socket_.non_blocking(true, ignored);
            socket_.write_some(asio::buffer(to_ivy_line(IvyType::bye, 0)), ignored);
        }
        socket_.shutdown(tcp::socket::shutdown_both, ignored);
        socket_.close(ignored);
    }

    /// Closes and removes this connection.
    void lose() {
        if (closed_) return;
        const auto self = shared_from_this();
        close();
        if (std::exchange(ready_, false)) agent_.setup_.on_peer_lost();
        agent_.peers_.remove(self);
    }

    bool is_of(const IvyAnnouncement& announcement, const asio::ip::address& from) const {
        return address_ == from && service_port_ == announcement.port &&
               (announced_id_.empty() || announced_id_ == announcement.id);
    }
    bool is_duplicate_of(const Peer& other) const {
        return this != &other && address_ == other.address_ && service_port_ == other.service_port_;
    }
    bool ready() const { return ready_; }
    std::size_t waiting_bytes() const { return outgoing_.size() + writing_.size(); }
    /// The same number at both ends: of two connections between two agents, both retire that of the higher number.
    std::uint16_t higher_port() const {
        error_code ignored;
        return std::max(socket_.local_endpoint(ignored).port(), socket_.remote_endpoint(ignored).port());
    }

  private:
    void handle(std::string_view bytes) {
        lines_.clear();
        for (auto overlong = buffer_.push(bytes, lines_); overlong > 0; --overlong)
            agent_.setup_.on_unusable("lines longer than any message");
        for (const auto& line : lines_) {
            if (closed_) return;
            if (line.empty()) continue;
            if (const auto parsed = parse_ivy_line(line)) {
                handle(*parsed);
            } else {
                agent_.setup_.on_unusable("lines that are not of the Ivy protocol");
            }
        }
    }

    void handle(const IvyLine& line) {
        switch (static_cast<IvyType>(line.type)) {
            case IvyType::start:
                if (line.id > 0 && line.id <= std::numeric_limits<std::uint16_t>::max())
                    service_port_ = static_cast<std::uint16_t>(line.id);
                return;
            case IvyType::end_of_subscriptions:
                if (retired_) return;
                ready_ = true;
                return agent_.retire_duplicate(*this);
            case IvyType::message:
                return agent_.setup_.on_message(split_groups(line.arguments));
            case IvyType::ping:
                return write(to_ivy_line(IvyType::pong, line.id));
            case IvyType::bye:
                other_ended_ = true;
                return retired_ && waiting_bytes() > 0 ? void() : lose();
            case IvyType::subscribe:  // nothing is sent to them
            case IvyType::unsubscribe:
            case IvyType::pong:
                return;
            case IvyType::error:
            case IvyType::die:
            case IvyType::direct:
                break;
        }
        agent_.setup_.on_unusable(fmt::format("Ivy lines of type {}, which are ignored", line.type));
    }

    void write(std::string_view text) {
        constexpr std::size_t max_waiting_bytes = 4'000'000;
        if (closed_ || !begun_) return;
        if (outgoing_.size() + text.size() > max_waiting_bytes)
            return agent_.setup_.on_unusable("messages lost as an agent does not read them");
        outgoing_ += text;
        if (writing_.empty()) write_next();
    }

    void write_next() {
        std::swap(writing_, outgoing_);
        if (writing_.empty()) return other_ended_ ? lose() : void();
        asio::async_write(socket_, asio::buffer(writing_),
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                              self->writing_.clear();
                              if (self->closed_) return;
                              error ? self->lose() : self->write_next();
                          });
    }

    IvyAgent& agent_;
    tcp::socket socket_;
    asio::ip::address address_;
    std::string announced_id_;
    std::uint16_t service_port_ = 0;  ///< 0: not known yet
    bool begun_ = false, ready_ = false, retired_ = false, other_ended_ = false, closed_ = false;
    std::array<char, 16'384> received_{};
    LineBuffer buffer_;
    std::vector<std::string> lines_;
    std::string outgoing_, writing_;
};

IvyAgent::IvyAgent(asio::io_context& context, IvyAgentSetup setup)
    : context_(context), setup_(std::move(setup)), bus_socket_(context), acceptor_(context) {
    open_bus(bus_socket_, setup_.bus);
    error_code error;
    acceptor_.open(tcp::v4(), error);
    // On a bus of this machine, only this machine can connect.
    if (!error) acceptor_.bind({is_local() ? asio::ip::address_v4::loopback() : asio::ip::address_v4(), 0}, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    check(error, setup_.bus, "accept connections");
    close_on_exec(acceptor_);
    port_ = acceptor_.local_endpoint().port();
    std::random_device random;
    id_ = fmt::format("flightwatt:{:08x}{:08x}:{}", random(), random(), port_);
    asio::co_spawn(
        context_,
        accept_connections(acceptor_,
                           [this](tcp::socket socket) { add_peer(std::make_shared<Peer>(*this, std::move(socket))); }),
        asio::detached);
    asio::co_spawn(context_, listen_for_announcements(), asio::detached);
    asio::co_spawn(context_, announce_while_alone(), asio::detached);
}

IvyAgent::~IvyAgent() {
    for (const auto& peer : peers_) peer->close();
}

void IvyAgent::announce() {
    const auto datagram = to_datagram({port_, id_, setup_.name});
    error_code error;
    bus_socket_.send_to(asio::buffer(datagram), setup_.bus, 0, error);
    if (error) setup_.on_unusable("announcements that the network did not accept");
}

asio::awaitable<void> IvyAgent::announce_while_alone() {
    asio::steady_timer timer(context_);
    for (;;) {
        if (std::ranges::none_of(peers_, [](const auto& peer) { return peer->ready(); })) announce();
        timer.expires_after(announce_interval);
        co_await timer.async_wait(use_awaitable);
    }
}

asio::awaitable<void> IvyAgent::listen_for_announcements() {
    std::array<char, 4096> datagram{};
    udp::endpoint from;
    for (;;) {
        error_code error;
        const auto count =
            co_await bus_socket_.async_receive_from(asio::buffer(datagram), from, redirect_error(use_awaitable, error));
        if (error) continue;
        if (const auto announcement = parse_announcement({datagram.data(), count}))
            handle_announcement(*announcement, from.address());
        else
            setup_.on_unusable("announcements that are not of the Ivy protocol, version 3");
    }
}

void IvyAgent::handle_announcement(const IvyAnnouncement& announcement, const asio::ip::address& from) {
    if (announcement.id == id_ || (is_local() && !from.is_loopback())) return;
    if (std::ranges::any_of(peers_, [&](const auto& peer) { return peer->is_of(announcement, from); })) return;
    add_peer(std::make_shared<Peer>(*this, tcp::endpoint(from, announcement.port), announcement.id));
}

void IvyAgent::add_peer(const std::shared_ptr<Peer>& peer) {
    constexpr std::size_t max_peers = 64;
    if (peers_.size() >= max_peers) return setup_.on_unusable("agents beyond the limit of 64 connections");
    peers_.push_back(peer);
    asio::co_spawn(context_, peer->run(), [peer](const std::exception_ptr&) { peer->lose(); });
}

/// Two agents that announce themselves at the same time connect twice.
void IvyAgent::retire_duplicate(Peer& peer) {
    for (const auto& other : peers_) {
        if (other->ready() && other->is_duplicate_of(peer))
            return other->higher_port() > peer.higher_port() ? other->retire() : peer.retire();
    }
}

}  // namespace flightwatt::live
