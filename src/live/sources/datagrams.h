#pragma once

#include <string_view>
#include <utility>  // boost/asio/awaitable.hpp uses std::exchange

#include <boost/asio.hpp>

namespace flightwatt::live {

/// Sends datagrams to an address; without a receiver they are lost, as over the air.
class Datagrams {
  public:
    /// `to` is "127.0.0.1:4242"; throws UsageError for another text.
    explicit Datagrams(std::string_view to);
    /// Returns an empty text, or the reason why the bytes were not sent.
    std::string_view send(std::string_view bytes);

  private:
    boost::asio::ip::udp::endpoint to_;
    boost::asio::io_context context_;
    boost::asio::ip::udp::socket socket_;
};

}  // namespace flightwatt::live
