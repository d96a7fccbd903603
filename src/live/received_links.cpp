#include "live/received_links.h"

#include "base/error.h"
#include "flight/telemetry_series.h"
#include "live/sources/endpoints.h"
#include "live/sources/ivy_agent.h"
#include "live/sources/message_readers.h"
#include "telemetry/mavlink_sender.h"

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include <boost/asio.hpp>
#include <fmt/format.h>
#include <unistd.h>

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
    bool send(std::string_view bytes) override {
        if constexpr (requires { receiver_.send(std::string()); }) {
            asio::post(context_, [this, packet = std::string(bytes)] { receiver_.send(packet); });
            return true;
        }
        return false;
    }
    const SourceReport& report() const override { return report_; }

  private:
    asio::io_context context_;
    MessageQueue queue_;
    Receiver receiver_;
    SourceReport report_;
    std::thread thread_;
};

/// The reader of a stream whose messages go to a queue.
using ReaderFor = std::function<std::unique_ptr<ByteReader>(MessageQueue&)>;

/// Datagrams. Each sender has a reader of its own, so that damage in one stream does not affect another.
class UdpReceiver {
  public:
    UdpReceiver(asio::io_context& context, MessageQueue& queue, const udp::endpoint& at, ReaderFor reader_for)
        : queue_(queue), reader_for_(std::move(reader_for)), socket_(context) {
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

    /// Sends to all from which datagrams came.
    void send(const std::string& packet) {
        error_code ignored;
        socket_.non_blocking(true, ignored);
        for (const auto& [sender, reader] : readers_) socket_.send_to(asio::buffer(packet), sender, 0, ignored);
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

    ByteReader& reader_of(const udp::endpoint& sender) {
        constexpr std::size_t max_senders = 16;
        if (readers_.size() == max_senders && !readers_.contains(sender)) readers_.clear();
        auto& reader = readers_[sender];
        if (!reader) reader = reader_for_(queue_);
        return *reader;
    }

    MessageQueue& queue_;
    ReaderFor reader_for_;
    udp::socket socket_;
    std::array<char, 65'536> datagram_{};
    std::map<udp::endpoint, std::unique_ptr<ByteReader>> readers_;
};

/// The bytes of a serial line. A device that was unplugged is reopened.
class SerialReceiver {
  public:
    /// Throws InputError where the device is missing or does not support the speed.
    SerialReceiver(asio::io_context& context, MessageQueue& queue, SerialLine line, const ReaderFor& reader_for)
        : queue_(queue), line_(std::move(line)), port_(context), timer_(context), reader_(reader_for(queue)) {
        if (const auto error = open_serial_line(line_, port_)) {
            throw InputError(
                {line_.device},
                fmt::format("cannot open it as a serial line of {} baud: {}", line_.baud, error.message()),
                "check that it is plugged in, readable and writable (group dialout), and supports the speed");
        }
        asio::co_spawn(context, run(), asio::detached);
    }

    /// Asio opens devices so that a write does not wait.
    void send(const std::string& packet) {
        if (port_.is_open() && ::write(port_.native_handle(), packet.data(), packet.size()) < 0) return;
    }

  private:
    asio::awaitable<void> run() {
        for (;;) {
            error_code error;
            const auto count = co_await port_.async_read_some(asio::buffer(received_),
                                                              asio::redirect_error(asio::use_awaitable, error));
            reader_->push({received_.data(), count});
            if (!error) continue;
            reader_->restart();
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
    std::unique_ptr<ByteReader> reader_;
    std::array<char, 4096> received_{};
};

/// The bytes of a connection to a program, over TCP or (udpout) as datagrams after it heard of this one. A connection that
/// is lost is opened again.
template <typename Protocol>
class ConnectedReceiver {
  public:
    /// `greeting` is sent once a second, if it is not empty.
    ConnectedReceiver(asio::io_context& context, MessageQueue& queue, std::string host, std::string port,
                      std::function<std::string()> greeting, const ReaderFor& reader_for)
        : queue_(queue),
          host_(std::move(host)),
          port_(std::move(port)),
          greeting_(std::move(greeting)),
          socket_(context),
          timer_(context),
          reader_(reader_for(queue)) {
        if (const auto error = connect()) {
            throw InputError({fmt::format("{}:{}", host_, port_)}, fmt::format("cannot connect: {}", error.message()),
                             "check that the program that sends MAVLink runs, and its address");
        }
        asio::co_spawn(context, receive(), asio::detached);
        if (greeting_) asio::co_spawn(context, greet(), asio::detached);
    }

    void send(const std::string& packet) {
        error_code ignored;
        socket_.non_blocking(true, ignored);
        socket_.send(asio::buffer(packet), 0, ignored);
    }

  private:
    error_code connect() {
        error_code error;
        typename Protocol::resolver resolver(socket_.get_executor());
        const auto found = resolver.resolve(host_, port_, error);
        if (!error) asio::connect(socket_, found, error);
        if (!error) close_on_exec(socket_);
        return error;
    }

    asio::awaitable<void> receive() {
        for (;;) {
            error_code error;
            const auto count = co_await socket_.async_receive(asio::buffer(received_),
                                                              asio::redirect_error(asio::use_awaitable, error));
            if (!error) reader_->push({received_.data(), count});
            if (!error) continue;
            reader_->restart();
            do {
                socket_.close(error);
                asio::steady_timer pause(socket_.get_executor(), std::chrono::seconds(1));
                co_await pause.async_wait(asio::use_awaitable);
            } while (connect());
            queue_.count_restart();
        }
    }

    asio::awaitable<void> greet() {
        for (;;) {
            error_code ignored;
            const auto packet = greeting_();
            socket_.send(asio::buffer(packet), 0, ignored);
            timer_.expires_after(std::chrono::seconds(1));
            co_await timer_.async_wait(asio::use_awaitable);
        }
    }

    MessageQueue& queue_;
    std::string host_;
    std::string port_;
    std::function<std::string()> greeting_;
    typename Protocol::socket socket_;
    asio::steady_timer timer_;
    std::unique_ptr<ByteReader> reader_;
    std::array<char, 65'536> received_{};
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

/// Readers of Paparazzi's frames; on a serial line they may be an XBee's packets.
ReaderFor link_readers(telemetry::MessageDictionary definitions, std::optional<telemetry::Framing> framing) {
    const auto shared = std::make_shared<const telemetry::MessageDictionary>(std::move(definitions));
    return [=](MessageQueue& queue) { return std::make_unique<LinkReader>(queue, shared, framing); };
}

/// Readers of MAVLink that know the same vehicles.
ReaderFor mavlink_readers() {
    const auto vehicles = std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages());
    return [=](MessageQueue& queue) { return std::make_unique<MavlinkReader>(queue, vehicles, false); };
}

/// Splits "HOST:PORT". Throws UsageError for another text.
std::pair<std::string, std::string> host_and_port(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size())
        throw UsageError(fmt::format("'{}': expected HOST:PORT", text));
    return {std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

}  // namespace

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource<IvyReceiver>>(clock_factor, parse_ivy_bus(bus));
}

std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor) {
    return std::make_unique<ReceivingSource<UdpReceiver>>(
        clock_factor, parse_udp_address(at), link_readers(std::move(definitions), telemetry::Framing::link));
}

std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor) {
    return std::make_unique<ReceivingSource<SerialReceiver>>(clock_factor, parse_serial_line(line),
                                                             link_readers(std::move(definitions), std::nullopt));
}

std::unique_ptr<MessageSource> open_mavlink(std::string_view link, double clock_factor) {
    const auto behind = [&](std::string_view prefix) { return link.substr(prefix.size()); };
    if (link.starts_with("udp:"))
        return std::make_unique<ReceivingSource<UdpReceiver>>(clock_factor, parse_udp_address(behind("udp:")),
                                                              mavlink_readers());
    if (link.starts_with("udpout:")) {
        const auto [host, port] = host_and_port(behind("udpout:"));
        const auto heartbeat = [sender = telemetry::MavlinkSender()]() mutable { return sender.heartbeat(); };
        return std::make_unique<ReceivingSource<ConnectedReceiver<udp>>>(clock_factor, host, port, heartbeat,
                                                                         mavlink_readers());
    }
    if (link.starts_with("tcp:")) {
        const auto [host, port] = host_and_port(behind("tcp:"));
        return std::make_unique<ReceivingSource<ConnectedReceiver<asio::ip::tcp>>>(
            clock_factor, host, port, std::function<std::string()>(), mavlink_readers());
    }
    if (link.starts_with('/'))
        return std::make_unique<ReceivingSource<SerialReceiver>>(clock_factor, parse_serial_line(link),
                                                                 mavlink_readers());
    throw UsageError(fmt::format(
        "'{}': expected udp:14550, udpout:HOST:PORT, tcp:HOST:PORT or a serial line /dev/ttyUSB0:57600", link));
}

}  // namespace flightwatt::live
