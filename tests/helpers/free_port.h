#pragma once

#include <cstdint>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

namespace flightwatt::test {

/// A UDP port that nobody uses now.
inline std::uint16_t free_udp_port() {
    boost::asio::io_context context;
    const boost::asio::ip::udp::socket socket(context, {boost::asio::ip::udp::v4(), 0});
    return socket.local_endpoint().port();
}

}  // namespace flightwatt::test
