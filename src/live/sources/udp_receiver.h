#pragma once

#include "live/sources/link_reader.h"
#include "live/sources/receiving_source.h"

#include <array>
#include <cstdint>
#include <list>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

namespace flightwatt::live {

/// Link frames that come in over UDP. What each sender says is taken apart for itself: one's garbage spoils nothing of
/// another's.
class UdpReceiver : public Receiver {
  public:
    UdpReceiver(boost::asio::io_context& context, MessageQueue& queue, const boost::asio::ip::udp::endpoint& at,
                telemetry::MessageDictionary dictionary);

    std::string description() const override;
    void start() override { listen(); }
    void stop() override;

  private:
    using Endpoint = boost::asio::ip::udp::endpoint;

    void listen();
    LinkReader& reader_of(const Endpoint& sender);

    MessageQueue& queue_;
    telemetry::MessageDictionary dictionary_;
    boost::asio::ip::udp::socket socket_;
    Endpoint from_;
    std::array<char, 65'536> datagram_{};
    std::list<std::pair<Endpoint, LinkReader>> readers_;  ///< who was heard last stands first
};

}  // namespace flightwatt::live
