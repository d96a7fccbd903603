#include "live/sources/endpoints.h"

#include "base/error.h"
#include "base/number.h"

#include <csignal>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {

std::optional<HostAndPort> parse_host_and_port(std::string_view text, std::string_view host) {
    const auto colon = text.rfind(':');
    if (colon != std::string_view::npos) host = text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    const auto port = parse_unsigned(colon == std::string_view::npos ? text : text.substr(colon + 1));
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(host), error);
    if (error || !port || *port == 0 || *port > std::numeric_limits<std::uint16_t>::max()) return std::nullopt;
    return HostAndPort{std::string(host), static_cast<std::uint16_t>(*port)};
}

boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text) {
    const auto where = parse_host_and_port(text, "0.0.0.0");
    if (where) return {boost::asio::ip::make_address(where->host), where->port};
    throw UsageError(fmt::format("UDP '{}': expected PORT or ADDRESS:PORT, as 4242 or 127.0.0.1:4242", text));
}

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

boost::system::error_code open_serial_line(const SerialLine& line, boost::asio::serial_port& port) {
    using Port = boost::asio::serial_port;
    boost::system::error_code error;
    port.open(line.device, error);  // in the system's raw mode
    if (!error) port.set_option(Port::baud_rate(line.baud), error);
    if (!error) port.set_option(Port::character_size(8), error);
    if (!error) port.set_option(Port::parity(Port::parity::none), error);
    if (!error) port.set_option(Port::stop_bits(Port::stop_bits::one), error);
    if (!error) port.set_option(Port::flow_control(Port::flow_control::none), error);
    if (error) {
        boost::system::error_code ignored;
        port.close(ignored);
        return error;
    }
    close_on_exec(port);
    return error;
}

void refuse_serial_line(const SerialLine& line, const boost::system::error_code& error) {
    throw InputError({line.device},
                     fmt::format("cannot open it as a serial line of {} baud: {}", line.baud, error.message()),
                     "see that it is plugged in, may be read and written (group dialout), and knows the speed");
}

std::thread start_without_signals(std::function<void()> work) {
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(work));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

}  // namespace flightwatt::live
