#include "base/error.h"
#include "live/sources.h"
#include "live/sources/endpoints.h"
#include "live/sources/message_readers.h"
#include "live/sources/receiving_source.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using boost::asio::ip::udp;
using boost::system::error_code;

/// Link frames that come in over UDP. The bytes of each sender are read separately: damage in one's does not spoil
/// another's.
class UdpReceiver {
  public:
    UdpReceiver(boost::asio::io_context& context, MessageQueue& queue, const udp::endpoint& at,
                LinkReader::Definitions definitions)
        : queue_(queue), definitions_(std::move(definitions)), socket_(context) {
        error_code error, ignored;
        socket_.open(at.protocol(), error);
        if (!error) socket_.bind(at, error);
        if (error) {
            throw InputError({fmt::format("UDP {}:{}", at.address().to_string(), at.port())},
                             fmt::format("cannot listen: {}", error.message()),
                             "see which program has the port (ss -lup), or take another one");
        }
        close_on_exec(socket_);
        constexpr int receive_buffer_bytes = 1 << 20;
        socket_.set_option(boost::asio::socket_base::receive_buffer_size(receive_buffer_bytes), ignored);
    }

    std::string description() const {
        const auto at = socket_.local_endpoint();
        if (at.address().is_unspecified()) return fmt::format("UDP port {}", at.port());
        return fmt::format("UDP {}:{}", at.address().to_string(), at.port());
    }

    void start() {
        socket_.async_receive_from(boost::asio::buffer(datagram_), from_,
                                   [this](const error_code& error, std::size_t bytes) {
                                       if (!socket_.is_open()) return;
                                       if (!error) reader_of(from_).push({datagram_.data(), bytes});
                                       start();
                                   });
    }

    void stop() {
        error_code ignored;
        socket_.close(ignored);
    }

  private:
    LinkReader& reader_of(const udp::endpoint& sender) {
        constexpr std::size_t max_senders = 16;
        if (readers_.size() == max_senders && !readers_.contains(sender)) readers_.clear();
        return readers_.try_emplace(sender, queue_, definitions_, telemetry::Framing::link).first->second;
    }

    MessageQueue& queue_;
    LinkReader::Definitions definitions_;
    udp::socket socket_;
    udp::endpoint from_;
    std::array<char, 65'536> datagram_{};
    std::map<udp::endpoint, LinkReader> readers_;
};

/// Link frames, or an XBee's packets, that come in over a serial line. A device that is unplugged is opened again when
/// it is back.
class SerialReceiver {
  public:
    /// Throws InputError where the device is not there, or does not know the speed.
    SerialReceiver(boost::asio::io_context& context, MessageQueue& queue, SerialLine line,
                   LinkReader::Definitions definitions)
        : queue_(queue),
          line_(std::move(line)),
          port_(context),
          timer_(context),
          reader_(queue, std::move(definitions)) {
        if (const auto error = open_serial_line(line_, port_)) refuse_serial_line(line_, error);
    }

    std::string description() const { return fmt::format("{} at {} baud", line_.device, line_.baud); }

    void start() {
        port_.async_read_some(boost::asio::buffer(received_), [this](const error_code& error, std::size_t bytes) {
            if (stopped_) return;
            reader_.push({received_.data(), bytes});
            if (!error) return start();
            reader_.restart();
            error_code ignored;
            port_.close(ignored);
            reopen_later();
        });
    }

    void stop() {
        stopped_ = true;
        error_code ignored;
        timer_.cancel(ignored);
        port_.close(ignored);
    }

  private:
    void reopen_later() {
        timer_.expires_after(std::chrono::milliseconds(250));
        timer_.async_wait([this](const error_code& error) {
            if (error || stopped_) return;
            if (open_serial_line(line_, port_)) return reopen_later();
            queue_.count_restart();
            start();
        });
    }

    MessageQueue& queue_;
    SerialLine line_;
    boost::asio::serial_port port_;
    boost::asio::steady_timer timer_;
    LinkReader reader_;
    std::array<char, 4096> received_{};
    bool stopped_ = false;
};

LinkReader::Definitions share(telemetry::MessageDictionary definitions) {
    return std::make_shared<const telemetry::MessageDictionary>(std::move(definitions));
}

}  // namespace

std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor) {
    return std::make_unique<ReceivingSource<UdpReceiver>>(clock_factor, parse_udp_address(at),
                                                          share(std::move(definitions)));
}

std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor) {
    return std::make_unique<ReceivingSource<SerialReceiver>>(clock_factor, parse_serial_line(line),
                                                             share(std::move(definitions)));
}

}  // namespace flightwatt::live
