#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>  // boost/asio/awaitable.hpp uses std::exchange

#include <boost/asio.hpp>
#include <fcntl.h>

/// Names of addresses and devices, and helpers common to all sockets.
namespace flightwatt::live {

struct AddressAndPort {
    boost::asio::ip::address address;
    std::uint16_t port = 0;
};

/// "4242" (of `default_address`), "127.0.0.1:4242", "[::1]:4242". std::nullopt for any other text.
std::optional<AddressAndPort> parse_address_and_port(std::string_view text, std::string_view default_address);

/// "4242" (any address), "127.0.0.1:4242". Throws UsageError.
boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text);

struct SerialLine {
    std::string device;
    unsigned baud = 0;
};

/// "/dev/ttyUSB0:57600"; the device name may contain colons. Throws UsageError.
SerialLine parse_serial_line(std::string_view text);

/// Opens it with eight bits, no parity, one stop bit and no flow control; closed again if that fails.
boost::system::error_code open_serial_line(const SerialLine& line, boost::asio::serial_port& port);

/// Child processes do not inherit a socket or a device. (Asio does not set this flag.)
template <typename Opened>
void close_on_exec(Opened& opened) {
    ::fcntl(opened.native_handle(), F_SETFD, FD_CLOEXEC);
}

/// Passes accepted connections to `handle`. While no file descriptor is free, it waits.
boost::asio::awaitable<void> accept_connections(boost::asio::ip::tcp::acceptor& acceptor,
                                                std::function<void(boost::asio::ip::tcp::socket)> handle);

/// Starts a thread with all signals blocked; the main thread handles them.
std::thread start_without_signals(std::function<void()> work);

}  // namespace flightwatt::live
