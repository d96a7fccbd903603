#include "live/sources/ivy_agent.h"

#include "base/error.h"
#include "live/sources/endpoints.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/write.hpp>
#include <boost/regex.hpp>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using boost::system::error_code;

/// An announcement is a single datagram, which may be lost: while nobody has answered it is said again. Never to those
/// who have: Ivy's C library would connect once more.
constexpr std::chrono::seconds announce_again{1};

using ReusePort = asio::detail::socket_option::boolean<SOL_SOCKET, SO_REUSEPORT>;

void check(const error_code& error, const IvyBus& bus, const char* what) {
    if (!error) return;
    throw InputError({fmt::format("Ivy bus {}:{}", bus.networks.front(), bus.port)},
                     fmt::format("cannot {}: {}", what, error.message()),
                     "see that the network is there and no other program holds the port for itself");
}

void open_bus(udp::socket& socket, const IvyBus& bus) {
    error_code error;
    socket.open(udp::v4(), error);
    check(error, bus, "open a UDP socket");
    socket.set_option(asio::socket_base::reuse_address(true), error);
    socket.set_option(ReusePort(true), error);
    socket.set_option(asio::socket_base::broadcast(true), error);
    socket.bind({udp::v4(), bus.port}, error);
    check(error, bus, "listen for announcements");
    for (const auto& network : bus.networks) {
        const auto address = asio::ip::make_address_v4(network);
        if (address.is_multicast()) socket.set_option(asio::ip::multicast::join_group(address), error);
        check(error, bus, "join its group");
    }
}

/// An agent whose machine is gone says nothing any more: the system finds out within a minute.
void keep_alive(tcp::socket& socket) {
    error_code ignored;
    socket.set_option(asio::socket_base::keep_alive(true), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>(20), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>(10), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>(3), ignored);
    socket.set_option(asio::ip::tcp::no_delay(true), ignored);
}

}  // namespace

/// The connection with another agent.
class IvyAgent::Peer : public std::enable_shared_from_this<Peer> {
  public:
    Peer(IvyAgent& agent, tcp::socket socket) : agent_(agent), socket_(std::move(socket)) {}

    /// Connects to an agent that was announced.
    void connect(const tcp::endpoint& to, std::string announced_id) {
        address_ = to.address();
        service_port_ = to.port();
        announced_id_ = std::move(announced_id);
        socket_.async_connect(to, [self = shared_from_this()](const error_code& error) {
            if (self->closed_) return;
            if (error) return self->lose();
            self->begin();
        });
    }

    /// The connection stands: sends our subscriptions, and listens.
    void begin() {
        error_code error;
        const auto remote = socket_.remote_endpoint(error);
        if (error) return lose();
        address_ = remote.address();
        begun_ = true;
        keep_alive(socket_);
        close_on_exec(socket_);
        auto hello = to_ivy_line(IvyType::start, agent_.port_, agent_.setup_.name);
        int id = 0;
        for (const auto& subscription : agent_.setup_.subscriptions)
            hello += to_ivy_line(IvyType::subscribe, id++, subscription);
        write(hello + to_ivy_line(IvyType::end_of_subscriptions, 0));
        listen();
    }

    void send(std::string_view message) {
        if (!ready_) return;
        for (const auto& [id, regexp] : subscriptions_) {
            boost::cmatch match;
            try {
                if (!boost::regex_search(message.begin(), message.end(), match, regexp)) continue;
            } catch (const std::runtime_error&) {
                continue;  // trying would take too long
            }
            std::string arguments;
            for (std::size_t group = 1; group < match.size(); ++group)
                arguments.append(match[group].first, match[group].second).push_back('\003');
            write(to_ivy_line(IvyType::message, id, arguments));
        }
    }

    /// This connection is one too many: no message is sent on it any more. It stays until the other end has said
    /// good-bye, too, so that what either has sent before still arrives.
    void retire() {
        retired_ = true;
        ready_ = false;
        write(to_ivy_line(IvyType::bye, 0));
    }

    /// With a good-bye where it can be sent.
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

    /// Whether this is the connection with the agent that takes connections there; `id`: as it was announced.
    bool is_of(const IvyAnnouncement& announcement, const asio::ip::address& from) const {
        return address_ == from && service_port_ == announcement.port &&
               (announced_id_.empty() || announced_id_ == announcement.id);
    }
    bool is_duplicate_of(const Peer& other) const {
        return this != &other && address_ == other.address_ && service_port_ == other.service_port_;
    }
    bool ready() const { return ready_; }
    std::size_t waiting_bytes() const { return outgoing_.size() + writing_.size(); }
    /// The same number at both ends: of two connections between two agents, the one of the higher is retired.
    std::uint16_t higher_port() const {
        error_code ignored;
        return std::max(socket_.local_endpoint(ignored).port(), socket_.remote_endpoint(ignored).port());
    }

  private:
    void listen() {
        socket_.async_read_some(asio::buffer(received_),
                                [self = shared_from_this()](const error_code& error, std::size_t n) {
                                    if (!self->closed_) self->handle({self->received_.data(), n});
                                    if (self->closed_) return;
                                    if (error) return self->lose();
                                    self->listen();
                                });
    }

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
        const auto& setup = agent_.setup_;
        switch (static_cast<IvyType>(line.type)) {
            case IvyType::start:
                if (line.id > 0 && line.id <= std::numeric_limits<std::uint16_t>::max())
                    service_port_ = static_cast<std::uint16_t>(line.id);
                return;
            case IvyType::subscribe:
                return subscribe(line);
            case IvyType::unsubscribe:
                subscriptions_.erase(line.id);
                return;
            case IvyType::end_of_subscriptions:
                if (retired_) return;
                ready_ = true;
                return agent_.retire_duplicate(*this);
            case IvyType::message:
                return setup.on_message(groups_of(line.arguments));
            case IvyType::ping:
                return write(to_ivy_line(IvyType::pong, line.id));
            case IvyType::bye:
                other_said_bye_ = true;
                return retired_ && waiting_bytes() > 0 ? void() : lose();
            case IvyType::error:
                return setup.on_unusable("errors that other agents report");
            case IvyType::die:
                return setup.on_unusable("requests to end, which are not followed");
            case IvyType::direct:
                return setup.on_unusable("messages to this agent alone, of which none is telemetry");
            case IvyType::pong:
                return;
        }
        setup.on_unusable("lines of a type that the Ivy protocol does not know");
    }

    void subscribe(const IvyLine& line) {
        constexpr std::size_t max_subscriptions = 4096;  // of one agent; Paparazzi's have some dozens
        if (!agent_.setup_.sends) return;
        const boost::regex regexp(line.arguments.begin(), line.arguments.end(),
                                  boost::regex::perl | boost::regex::no_except);
        if (regexp.status() != 0) return write(to_ivy_line(IvyType::error, line.id, "no regular expression"));
        if (subscriptions_.size() >= max_subscriptions && !subscriptions_.contains(line.id)) return;
        subscriptions_.insert_or_assign(line.id, regexp);
    }

    void write(std::string_view text) {
        constexpr std::size_t max_waiting_bytes = 4'000'000;
        if (closed_ || !begun_) return;
        if (outgoing_.size() + text.size() > max_waiting_bytes)
            return agent_.setup_.on_unusable("messages too many to send");
        outgoing_ += text;
        if (writing_.empty()) write_next();
    }

    void write_next() {
        std::swap(writing_, outgoing_);
        if (writing_.empty()) return other_said_bye_ ? lose() : void();
        asio::async_write(socket_, asio::buffer(writing_),
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                              self->writing_.clear();
                              if (self->closed_) return;
                              if (error) return self->lose();
                              self->write_next();
                          });
    }

    void lose() {
        const auto self = shared_from_this();
        const bool was_ready = ready_;
        close();
        if (was_ready) agent_.setup_.on_peer_lost();
        agent_.peers_.remove(self);
    }

    IvyAgent& agent_;
    tcp::socket socket_;
    asio::ip::address address_;
    std::string announced_id_;
    std::uint16_t service_port_ = 0;  ///< 0: not known yet
    bool begun_ = false, ready_ = false, retired_ = false, other_said_bye_ = false, closed_ = false;
    std::array<char, 16'384> received_{};
    LineBuffer buffer_;
    std::vector<std::string> lines_;
    std::map<int, boost::regex> subscriptions_;  ///< Perl's, as Ivy's libraries take them
    std::string outgoing_, writing_;
};

IvyAgent::IvyAgent(asio::io_context& context, IvyAgentSetup setup)
    : context_(context),
      setup_(std::move(setup)),
      bus_socket_(context),
      acceptor_(context),
      timer_(context),
      accept_timer_(context) {
    open_bus(bus_socket_, setup_.bus);
    error_code error;
    acceptor_.open(tcp::v4(), error);
    // On a bus of this machine alone nobody else is given a door.
    if (!error)
        acceptor_.bind({setup_.bus.is_local() ? asio::ip::address_v4::loopback() : asio::ip::address_v4(), 0}, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    check(error, setup_.bus, "take connections");
    close_on_exec(acceptor_);
    close_on_exec(bus_socket_);
    port_ = acceptor_.local_endpoint().port();
    std::random_device random;
    id_ = fmt::format("flightwatt:{:08x}{:08x}:{}", random(), random(), port_);  // another at each start
}

IvyAgent::~IvyAgent() = default;

void IvyAgent::start() {
    accept();
    listen_for_announcements();
    announce_while_alone();
}

void IvyAgent::stop() {
    stopped_ = true;
    error_code ignored;
    timer_.cancel(ignored);
    accept_timer_.cancel(ignored);
    acceptor_.close(ignored);
    bus_socket_.close(ignored);
    for (const auto& peer : peers_) peer->close();
    peers_.clear();
}

void IvyAgent::announce() {
    const auto datagram = to_datagram({port_, id_, setup_.name});
    for (const auto& network : setup_.bus.networks) {
        error_code error;
        bus_socket_.send_to(asio::buffer(datagram), {asio::ip::make_address_v4(network), setup_.bus.port}, 0, error);
        if (error) setup_.on_unusable("announcements that the network did not take");
    }
}

void IvyAgent::announce_while_alone() {
    if (stopped_) return;
    if (ready_peers() == 0) announce();
    timer_.expires_after(announce_again);
    timer_.async_wait([this](const error_code& error) {
        if (!error) announce_while_alone();
    });
}

void IvyAgent::listen_for_announcements() {
    bus_socket_.async_receive_from(asio::buffer(datagram_), from_, [this](const error_code& error, std::size_t n) {
        if (stopped_) return;
        if (!error) {
            const auto announcement = parse_announcement({datagram_.data(), n});
            if (announcement) {
                handle_announcement(*announcement, from_.address());
            } else {
                setup_.on_unusable("announcements that are not of the Ivy protocol, version 3");
            }
        }
        listen_for_announcements();
    });
}

void IvyAgent::handle_announcement(const IvyAnnouncement& announcement, const asio::ip::address& from) {
    if (announcement.id == id_ || (setup_.bus.is_local() && !from.is_loopback())) return;
    if (std::ranges::any_of(peers_, [&](const auto& peer) { return peer->is_of(announcement, from); })) return;
    if (const auto peer = add_peer(tcp::socket(context_))) peer->connect({from, announcement.port}, announcement.id);
}

void IvyAgent::accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
        if (stopped_) return;
        if (error) return accept_later();
        if (const auto peer = add_peer(std::move(socket))) peer->begin();
        accept();
    });
}

/// The system has no more files for a while.
void IvyAgent::accept_later() {
    accept_timer_.expires_after(std::chrono::seconds(1));
    accept_timer_.async_wait([this](const error_code& error) {
        if (!error && !stopped_) accept();
    });
}

std::shared_ptr<IvyAgent::Peer> IvyAgent::add_peer(tcp::socket socket) {
    constexpr std::size_t max_peers = 64;
    if (peers_.size() >= max_peers) {
        setup_.on_unusable("agents too many to connect with");
        return nullptr;
    }
    return peers_.emplace_back(std::make_shared<Peer>(*this, std::move(socket)));
}

/// Two agents that announce themselves at the same time connect twice.
void IvyAgent::retire_duplicate(Peer& peer) {
    for (const auto& other : peers_) {
        if (other->ready() && other->is_duplicate_of(peer))
            return other->higher_port() > peer.higher_port() ? other->retire() : peer.retire();
    }
}

void IvyAgent::send(std::string_view message) {
    for (const auto& peer : peers_) peer->send(message);
}

std::size_t IvyAgent::ready_peers() const {
    return static_cast<std::size_t>(std::ranges::count_if(peers_, [](const auto& peer) { return peer->ready(); }));
}

std::size_t IvyAgent::waiting_bytes() const {
    std::size_t most = 0;
    for (const auto& peer : peers_) most = std::max(most, peer->waiting_bytes());
    return most;
}

}  // namespace flightwatt::live
