#pragma once

#include "live/sources/link_reader.h"
#include "live/sources/receiving_source.h"
#include "live/sources/serial_line.h"

#include <array>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>

namespace flightwatt::live {

/// Link frames, or an XBee's packets, that come in over a serial line: eight bits, no parity, one stop bit. A device
/// that is unplugged is opened again when it is back.
class SerialReceiver : public Receiver {
  public:
    /// Throws InputError where the device is not there, or does not know the speed.
    SerialReceiver(boost::asio::io_context& context, MessageQueue& queue, SerialLine line,
                   telemetry::MessageDictionary dictionary);

    std::string description() const override;
    void start() override { listen(); }
    void stop() override;

  private:
    boost::system::error_code open();
    void listen();
    void reopen_later();

    MessageQueue& queue_;
    SerialLine line_;
    telemetry::MessageDictionary dictionary_;
    boost::asio::serial_port port_;
    boost::asio::steady_timer timer_;
    std::optional<LinkReader> reader_;
    std::array<char, 4096> received_{};
    bool stopped_ = false;
};

}  // namespace flightwatt::live
