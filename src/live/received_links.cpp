#include "live/received_links.h"

#include "base/error.h"
#include "live/sources/endpoints.h"
#include "live/sources/ivy_agent.h"
#include "live/sources/message_readers.h"

#include <array>
#include <chrono>
#include <map>
#include <thread>
#include <utility>

#include <boost/asio.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

/// A source that receives in a thread of its own, so that no message is lost while the program computes. A Receiver
/// opens its sockets in its constructor, which may throw, and works in the context.
template <typename Receiver>
class ReceivingSource : public MessageSource {
  public:
    template <typename... Arguments>
    explicit ReceivingSource(double clock_factor, Arguments&&... arguments)
        : queue_(clock_factor),
          receiver_(context_, queue_, std::forward<Arguments>(arguments)...),
          thread_(start_without_signals([this] { context_.run(); })) {}
    ~ReceivingSource() override {
        context_.stop();
        thread_.join();
    }
    void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        queue_.take(timeout, messages, report_);
    }
    const SourceReport& report() const override { return report_; }

  private:
    asio::io_context context_;
    MessageQueue queue_;
    Receiver receiver_;
    SourceReport report_;
    std::thread thread_;
};

/// Link frames over UDP. Each sender has a reader of its own, so that damage in one stream does not affect another.
class UdpReceiver {
  public:
    UdpReceiver(asio::io_context& context, MessageQueue& queue, const udp::endpoint& at,
                LinkReader::Definitions definitions)
        : queue_(queue), definitions_(std::move(definitions)), socket_(context) {
        try {
            socket_ = udp::socket(context, at);
        } catch (const boost::system::system_error& error) {
            throw InputError({fmt::format("UDP {}:{}", at.address().to_string(), at.port())},
                             fmt::format("cannot listen: {}", error.code().message()),
                             "find the program that uses the port (ss -lup), or use another port");
        }
        close_on_exec(socket_);
        error_code ignored;
        constexpr int receive_buffer_bytes = 1 << 20;
        socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer_bytes), ignored);
        asio::co_spawn(context, run(), asio::detached);
    }

  private:
    asio::awaitable<void> run() {
        udp::endpoint from;
        for (;;) {
            error_code error;
            const auto count = co_await socket_.async_receive_from(asio::buffer(datagram_), from,
                                                                   asio::redirect_error(asio::use_awaitable, error));
            if (!error) reader_of(from).push({datagram_.data(), count});
        }
    }

    LinkReader& reader_of(const udp::endpoint& sender) {
        constexpr std::size_t max_senders = 16;
        if (readers_.size() == max_senders && !readers_.contains(sender)) readers_.clear();
        return readers_.try_emplace(sender, queue_, definitions_, telemetry::Framing::link).first->second;
    }

    MessageQueue& queue_;
    LinkReader::Definitions definitions_;
    udp::socket socket_;
    std::array<char, 65'536> datagram_{};
    std::map<udp::endpoint, LinkReader> readers_;
};

/// Link frames or XBee packets over a serial line. A device that was unplugged is reopened.
class SerialReceiver {
  public:
    /// Throws InputError where the device is missing or does not support the speed.
    SerialReceiver(asio::io_context& context, MessageQueue& queue, SerialLine line, LinkReader::Definitions definitions)
        : queue_(queue),
          line_(std::move(line)),
          port_(context),
          timer_(context),
          reader_(queue, std::move(definitions)) {
        if (const auto error = open_serial_line(line_, port_)) {
            throw InputError(
                {line_.device},
                fmt::format("cannot open it as a serial line of {} baud: {}", line_.baud, error.message()),
                "check that it is plugged in, readable and writable (group dialout), and supports the speed");
        }
        asio::co_spawn(context, run(), asio::detached);
    }

  private:
    asio::awaitable<void> run() {
        for (;;) {
            error_code error;
            const auto count = co_await port_.async_read_some(asio::buffer(received_),
                                                              asio::redirect_error(asio::use_awaitable, error));
            reader_.push({received_.data(), count});
            if (!error) continue;
            reader_.restart();
            port_.close(error);
            do {
                timer_.expires_after(std::chrono::milliseconds(250));
                co_await timer_.async_wait(asio::use_awaitable);
            } while (open_serial_line(line_, port_));
            queue_.count_restart();
        }
    }

    MessageQueue& queue_;
    SerialLine line_;
    asio::serial_port port_;
    asio::steady_timer timer_;
    LinkReader reader_;
    std::array<char, 4096> received_{};
};

/// Telemetry from an Ivy bus.
class IvyReceiver {
  public:
    IvyReceiver(asio::io_context& context, MessageQueue& queue, const udp::endpoint& bus)
        : messages_(queue),
          agent_(context,
                 {.bus = bus,
                  .name = "FlightWatt watch",
                  // Everything, as one group: each agent's library accepts it, and no agent takes it for a message
                  // that its program does not send.
                  .subscriptions = {"(.*)"},
                  .on_message = [this](const auto& groups) { messages_.handle(groups.empty() ? "" : groups.front()); },
                  .on_unusable = [&queue](std::string_view reason) { queue.count(reason, 1); },
                  .on_peer_lost = [&queue] { queue.count_restart(); }}) {}

  private:
    IvyMessages messages_;
    IvyAgent agent_;
};

LinkReader::Definitions share(telemetry::MessageDictionary definitions) {
    return std::make_shared<const telemetry::MessageDictionary>(std::move(definitions));
}

}  // namespace

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource<IvyReceiver>>(clock_factor, parse_ivy_bus(bus));
}

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
