#include "live/sources/ivy_agent.h"

#include "base/error.h"
#include "live/sources/close_on_exec.h"
#include "live/sources/ivy_peer.h"

#include <algorithm>
#include <random>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <fmt/format.h>
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
constexpr std::size_t max_peers = 64;

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

/// Another one for each agent and start, without blanks.
std::string new_id(std::uint16_t port) {
    std::random_device random;
    return fmt::format("flightwatt:{:08x}{:08x}:{}", random(), random(), port);
}

}  // namespace

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
    id_ = new_id(port_);
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
    const bool known = std::any_of(peers_.begin(), peers_.end(), [&](const auto& peer) {
        const bool may_be = peer->announced_id().empty() || peer->announced_id() == announcement.id;
        return may_be && peer->is_connected_to(from, announcement.port);
    });
    if (known) return;
    if (const auto peer = add_peer()) peer->connect({from, announcement.port}, announcement.id);
}

void IvyAgent::accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
        if (stopped_) return;
        if (error) return accept_later();
        if (const auto peer = add_peer()) {
            peer->socket() = std::move(socket);
            peer->begin();
        }
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

std::shared_ptr<IvyPeer> IvyAgent::add_peer() {
    if (peers_.size() >= max_peers) {
        setup_.on_unusable("agents too many to connect with");
        return nullptr;
    }
    return peers_.emplace_back(std::make_shared<IvyPeer>(*this, tcp::socket(context_)));
}

void IvyAgent::remove(const IvyPeer& peer) {
    peers_.remove_if([&](const auto& other) { return other.get() == &peer; });
}

/// Two agents that announce themselves at the same time connect twice.
void IvyAgent::retire_duplicate(IvyPeer& peer) {
    for (const auto& other : peers_) {
        if (other.get() == &peer || !other->ready() || !other->is_connected_to(peer.address(), peer.service_port()))
            continue;
        return other->higher_port() > peer.higher_port() ? other->retire() : peer.retire();
    }
}

void IvyAgent::send(std::string_view message) {
    for (const auto& peer : peers_) peer->send(message);
}

std::size_t IvyAgent::ready_peers() const {
    return static_cast<std::size_t>(
        std::count_if(peers_.begin(), peers_.end(), [](const auto& peer) { return peer->ready(); }));
}

std::size_t IvyAgent::waiting_bytes() const {
    std::size_t most = 0;
    for (const auto& peer : peers_) most = std::max(most, peer->waiting_bytes());
    return most;
}

}  // namespace flightwatt::live
