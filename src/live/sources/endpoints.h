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

/// Names of addresses and devices, and functions for all sockets.
namespace flightwatt::live {

/// An internet address and a port.
struct AddressAndPort {
    boost::asio::ip::address address;
    std::uint16_t port = 0;
};

/// Parses "4242" (at `default_address`), "127.0.0.1:4242" or "[::1]:4242"; std::nullopt for any other text.
std::optional<AddressAndPort> parse_address_and_port(std::string_view text, std::string_view default_address);

/// Parses "4242" (any address) or "127.0.0.1:4242". Throws UsageError for any other text.
boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text);

/// A device and its speed.
struct SerialLine {
    std::string device;
    unsigned baud = 0;
};

/// Parses "/dev/ttyUSB0:57600"; the device name may contain colons. Throws UsageError for any other text.
SerialLine parse_serial_line(std::string_view text);

/// Opens a serial line with eight bits, no parity, one stop bit and no flow control; closes it if that fails. Returns
/// the error.
boost::system::error_code open_serial_line(const SerialLine& line, boost::asio::serial_port& port);

/// Keeps child processes from inheriting a socket or a device; Asio does not set this flag.
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
