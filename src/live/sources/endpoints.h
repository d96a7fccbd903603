#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <boost/asio/ip/udp.hpp>
#include <boost/asio/serial_port.hpp>
#include <fcntl.h>

/// Addresses and devices by their names, and what all that uses them needs.
namespace flightwatt::live {

struct HostAndPort {
    std::string host;  ///< an address in numbers
    std::uint16_t port = 0;
};

/// "4242" (of `host`), "127.0.0.1:4242", "[::1]:4242". std::nullopt for any other text.
std::optional<HostAndPort> parse_host_and_port(std::string_view text, std::string_view host);

/// "4242" (any address), "127.0.0.1:4242". Throws UsageError.
boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text);

struct SerialLine {
    std::string device;
    unsigned baud = 0;
};

/// "/dev/ttyUSB0:57600"; device names may have colons of their own. Throws UsageError.
SerialLine parse_serial_line(std::string_view text);

/// Opens it with eight bits, no parity, one stop bit and no flow control; closed again where that fails.
boost::system::error_code open_serial_line(const SerialLine& line, boost::asio::serial_port& port);

/// Throws InputError: what could not be opened, and why.
[[noreturn]] void refuse_serial_line(const SerialLine& line, const boost::system::error_code& error);

/// Commands that the program runs do not inherit a port or a device. (Asio does not set this flag.)
template <typename Opened>
void close_on_exec(Opened& opened) {
    ::fcntl(opened.native_handle(), F_SETFD, FD_CLOEXEC);
}

/// A thread that receives no signals: they are for the one that the program waits in.
std::thread start_without_signals(std::function<void()> work);

}  // namespace flightwatt::live
