#pragma once

#include <cstdint>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>

namespace flightwatt::test {

/// A UDP port that is free now, as is the TCP port of its number.
inline std::uint16_t free_udp_port() {
    using boost::asio::ip::tcp;
    boost::asio::io_context context;
    for (;;) {
        const boost::asio::ip::udp::socket socket(context, {boost::asio::ip::udp::v4(), 0});
        const auto port = socket.local_endpoint().port();
        boost::system::error_code taken;
        tcp::socket(context, tcp::v4()).bind({tcp::v4(), port}, taken);
        if (!taken) return port;
    }
}

/// Someone has the port.
inline bool is_taken(std::uint16_t port) {
    boost::asio::io_context context;
    boost::system::error_code error;
    boost::asio::ip::udp::socket socket(context, boost::asio::ip::udp::v4());
    socket.bind({boost::asio::ip::udp::v4(), port}, error);
    return static_cast<bool>(error);
}

}  // namespace flightwatt::test
