#include "live/sources/host_and_port.h"

#include "base/error.h"
#include "base/number.h"

#include <limits>

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

}  // namespace flightwatt::live
