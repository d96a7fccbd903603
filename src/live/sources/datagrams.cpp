#include "live/sources/datagrams.h"

#include "live/sources/endpoints.h"

namespace flightwatt::live {

Datagrams::Datagrams(std::string_view to) : to_(parse_udp_address(to)), socket_(context_, to_.protocol()) {
    socket_.set_option(boost::asio::socket_base::broadcast(true));
}

std::string_view Datagrams::send(std::string_view bytes) {
    boost::system::error_code error;
    socket_.send_to(boost::asio::buffer(bytes), to_, 0, error);
    return error && error != boost::asio::error::connection_refused ? "the network did not accept them" : "";
}

}  // namespace flightwatt::live
