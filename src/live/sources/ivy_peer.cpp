#include "live/sources/ivy_peer.h"

#include "live/sources/close_on_exec.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::size_t max_subscriptions = 4096;  // of one agent; Paparazzi's have some dozens
constexpr std::size_t most_waiting_bytes = 4'000'000;

/// An agent whose machine is gone says nothing any more: the system finds out within a minute.
void keep_alive(asio::ip::tcp::socket& socket) {
    error_code ignored;
    socket.set_option(asio::socket_base::keep_alive(true), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>(20), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>(10), ignored);
    socket.set_option(asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>(3), ignored);
    socket.set_option(asio::ip::tcp::no_delay(true), ignored);
}

}  // namespace

IvyPeer::IvyPeer(IvyAgent& agent, asio::ip::tcp::socket socket) : agent_(agent), socket_(std::move(socket)) {}

void IvyPeer::connect(const asio::ip::tcp::endpoint& to, std::string announced_id) {
    address_ = to.address();
    service_port_ = to.port();
    announced_id_ = std::move(announced_id);
    socket_.async_connect(to, [self = shared_from_this()](const error_code& error) {
        if (self->closed_) return;
        if (error) return self->lose();
        self->begin();
    });
}

void IvyPeer::begin() {
    error_code error;
    const auto remote = socket_.remote_endpoint(error);
    if (error) return lose();
    address_ = remote.address();
    begun_ = true;
    keep_alive(socket_);
    close_on_exec(socket_);
    const auto& setup = agent_.setup();
    auto hello = to_ivy_line(IvyType::start, agent_.port(), setup.name);
    for (std::size_t i = 0; i < setup.subscriptions.size(); ++i) {
        hello += to_ivy_line(IvyType::subscribe, static_cast<int>(i), setup.subscriptions[i]);
    }
    write(hello + to_ivy_line(IvyType::end_of_subscriptions, 0));
    listen();
}

void IvyPeer::listen() {
    socket_.async_read_some(asio::buffer(received_),
                            [self = shared_from_this()](const error_code& error, std::size_t n) {
                                if (self->closed_) return;
                                self->lines_.clear();
                                self->buffer_.push({self->received_.data(), n}, self->lines_);
                                for (; self->overlong_ < self->buffer_.overlong(); ++self->overlong_) {
                                    self->agent_.setup().on_unusable("lines longer than any message");
                                }
                                for (const auto& line : self->lines_) {
                                    if (!self->closed_) self->handle_line(line);
                                }
                                if (self->closed_) return;
                                if (error) return self->lose();
                                self->listen();
                            });
}

void IvyPeer::handle_line(const std::string& line) {
    if (line.empty()) return;
    const auto parsed = parse_ivy_line(line);
    if (!parsed) return agent_.setup().on_unusable("lines that are not of the Ivy protocol");
    heed(*parsed);
}

void IvyPeer::heed(const IvyLine& line) {
    const auto& setup = agent_.setup();
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

void IvyPeer::subscribe(const IvyLine& line) {
    if (!agent_.setup().sends) return;
    const auto regexp = PerlRegexp::compile(std::string(line.arguments));
    if (!regexp) return write(to_ivy_line(IvyType::error, line.id, "no regular expression"));
    if (subscriptions_.size() >= max_subscriptions && !subscriptions_.contains(line.id)) return;
    subscriptions_.insert_or_assign(line.id, *regexp);
}

void IvyPeer::send(std::string_view message) {
    if (!ready_) return;
    for (const auto& [id, regexp] : subscriptions_) {
        const auto groups = regexp.groups_in(message);
        if (!groups) continue;
        std::string arguments;
        for (const auto group : *groups) arguments.append(group).push_back('\003');
        write(to_ivy_line(IvyType::message, id, arguments));
    }
}

void IvyPeer::retire() {
    retired_ = true;
    ready_ = false;
    write(to_ivy_line(IvyType::bye, 0));
}

void IvyPeer::write(std::string_view text) {
    if (closed_ || !begun_) return;
    if (outgoing_.size() + text.size() > most_waiting_bytes)
        return agent_.setup().on_unusable("messages too many to send");
    outgoing_ += text;
    if (writing_.empty()) write_next();
}

void IvyPeer::write_next() {
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

void IvyPeer::close() {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    if (begun_ && writing_.empty()) {
        socket_.non_blocking(true, ignored);
        socket_.write_some(asio::buffer(to_ivy_line(IvyType::bye, 0)), ignored);
    }
    socket_.shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
    socket_.close(ignored);
}

void IvyPeer::lose() {
    const auto self = shared_from_this();
    const bool was_ready = ready_;
    close();
    if (was_ready) agent_.setup().on_peer_lost();
    agent_.remove(*this);
}

bool IvyPeer::is_connected_to(const asio::ip::address& address, std::uint16_t service_port) const {
    return address_ == address && service_port_ == service_port;
}

std::uint16_t IvyPeer::higher_port() const {
    error_code ignored;
    return std::max(socket_.local_endpoint(ignored).port(), socket_.remote_endpoint(ignored).port());
}

}  // namespace flightwatt::live
