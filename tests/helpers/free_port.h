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

/// Somebody has the port.
inline bool is_taken(std::uint16_t port) {
    boost::asio::io_context context;
    boost::system::error_code error;
    boost::asio::ip::udp::socket socket(context, boost::asio::ip::udp::v4());
    socket.bind({boost::asio::ip::udp::v4(), port}, error);
    return static_cast<bool>(error);
}

}  // namespace flightwatt::test
