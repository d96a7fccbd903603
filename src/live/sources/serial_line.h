#pragma once

#include <string>
#include <string_view>

#include <boost/asio/serial_port.hpp>

namespace flightwatt::live {

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

}  // namespace flightwatt::live
