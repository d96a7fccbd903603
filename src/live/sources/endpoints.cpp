#include "live/sources/endpoints.h"

#include "base/error.h"
#include "base/number.h"

#include <chrono>
#include <csignal>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::live {

std::optional<AddressAndPort> parse_address_and_port(std::string_view text, std::string_view default_address) {
    const auto colon = text.rfind(':');
    auto host = colon == std::string_view::npos ? default_address : text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    const auto port = parse_unsigned(colon == std::string_view::npos ? text : text.substr(colon + 1));
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address(std::string(host), error);
    if (error || !port || *port == 0 || *port > std::numeric_limits<std::uint16_t>::max()) return std::nullopt;
    return AddressAndPort{address, static_cast<std::uint16_t>(*port)};
}

boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text) {
    if (const auto at = parse_address_and_port(text, "0.0.0.0")) return {at->address, at->port};
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
    try {
        port.open(line.device);  // in the system's raw mode
        port.set_option(Port::baud_rate(line.baud));
        port.set_option(Port::character_size(8));
        port.set_option(Port::parity(Port::parity::none));
        port.set_option(Port::stop_bits(Port::stop_bits::one));
        port.set_option(Port::flow_control(Port::flow_control::none));
        close_on_exec(port);
        return {};
    } catch (const boost::system::system_error& error) {
        if (port.is_open()) port.close();
        return error.code();
    }
}

boost::asio::awaitable<void> accept_connections(boost::asio::ip::tcp::acceptor& acceptor,
                                                std::function<void(boost::asio::ip::tcp::socket)> handle) {
    using boost::asio::use_awaitable;
    boost::asio::steady_timer timer(acceptor.get_executor());
    for (;;) {
        boost::system::error_code error;
        auto socket = co_await acceptor.async_accept(boost::asio::redirect_error(use_awaitable, error));
        if (error) {
            timer.expires_after(std::chrono::milliseconds(500));
            co_await timer.async_wait(use_awaitable);
            continue;
        }
        close_on_exec(socket);
        handle(std::move(socket));
    }
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
