#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/ip/udp.hpp>

namespace flightwatt::live {

struct HostAndPort {
    std::string host;  ///< an address in numbers
    std::uint16_t port = 0;
};

/// "4242" (of `host`), "127.0.0.1:4242", "[::1]:4242". std::nullopt for what is none.
std::optional<HostAndPort> parse_host_and_port(std::string_view text, std::string_view host);

/// "4242" (any address), "127.0.0.1:4242". Throws UsageError.
boost::asio::ip::udp::endpoint parse_udp_address(std::string_view text);

}  // namespace flightwatt::live
