#include "live/sources/serial_line.h"

#include "base/error.h"
#include "base/number.h"
#include "live/sources/close_on_exec.h"

#include <optional>

#include <fmt/format.h>

namespace flightwatt::live {

using Port = boost::asio::serial_port;
using boost::system::error_code;

SerialLine parse_serial_line(std::string_view text) {
    constexpr unsigned default_baud = 57'600;  // of Paparazzi's modems
    constexpr unsigned max_baud = 4'000'000;
    const auto colon = text.rfind(':');
    const auto baud = colon == std::string_view::npos ? std::nullopt : parse_unsigned(text.substr(colon + 1));
    if (!baud) return {std::string(text), default_baud};
    if (colon == 0 || *baud == 0 || *baud > max_baud) {
        throw UsageError(fmt::format("serial line '{}': expected DEVICE:BAUD, as /dev/ttyUSB0:57600", text));
    }
    return {std::string(text.substr(0, colon)), static_cast<unsigned>(*baud)};
}

error_code open_serial_line(const SerialLine& line, Port& port) {
    error_code error;
    port.open(line.device, error);  // in the system's raw mode
    if (!error) port.set_option(Port::baud_rate(line.baud), error);
    if (!error) port.set_option(Port::character_size(8), error);
    if (!error) port.set_option(Port::parity(Port::parity::none), error);
    if (!error) port.set_option(Port::stop_bits(Port::stop_bits::one), error);
    if (!error) port.set_option(Port::flow_control(Port::flow_control::none), error);
    if (error) {
        error_code ignored;
        port.close(ignored);
        return error;
    }
    close_on_exec(port);
    return error;
}

void refuse_serial_line(const SerialLine& line, const error_code& error) {
    throw InputError({line.device},
                     fmt::format("cannot open it as a serial line of {} baud: {}", line.baud, error.message()),
                     "see that it is plugged in, may be read and written (group dialout), and knows the speed");
}

}  // namespace flightwatt::live
