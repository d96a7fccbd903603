#include "base/error.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "live/playback.h"
#include "live/sources/endpoints.h"
#include "live/sources/ivy_agent.h"
#include "telemetry/link_encoder.h"

#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

using Clock = std::chrono::steady_clock;

/// Link frames, a datagram each. Datagrams that nobody listens for are lost, as over the air.
class UdpTarget : public PlaybackTarget {
  public:
    UdpTarget(std::string_view to, PlaybackTargetSetup setup)
        : definitions_(std::move(setup.definitions.value())),
          encoder_(definitions_, setup.version),
          to_(parse_udp_address(to)),
          socket_(context_, to_.protocol()) {
        socket_.set_option(boost::asio::socket_base::broadcast(true));
    }

    std::string_view send(const PlayedMessage& message) override {
        frame_.clear();
        const auto why_not = encoder_.append_frame(message.text, frame_);
        if (!why_not.empty()) return why_not;
        boost::system::error_code error;
        socket_.send_to(boost::asio::buffer(frame_), to_, 0, error);
        return error && error != boost::asio::error::connection_refused ? "the network did not take them" : "";
    }

  private:
    telemetry::MessageDictionary definitions_;
    telemetry::LinkEncoder encoder_;
    boost::asio::ip::udp::endpoint to_;
    boost::asio::io_context context_;
    boost::asio::ip::udp::socket socket_;
    std::string frame_;
};

/// Link frames on a serial line, which asio opens without blocking. What it does not take at once waits, but no more
/// than some minutes of a modem's.
class SerialTarget : public PlaybackTarget {
  public:
    SerialTarget(std::string_view to, PlaybackTargetSetup setup)
        : definitions_(std::move(setup.definitions.value())),
          encoder_(definitions_, setup.version),
          line_(parse_serial_line(to)) {
        register_output(line_.device);
        if (const auto error = open_serial_line(line_, port_)) refuse_serial_line(line_, error);
    }

    std::string_view send(const PlayedMessage& message) override {
        frame_.clear();
        const auto why_not = encoder_.append_frame(message.text, frame_);
        if (!why_not.empty()) return why_not;
        write();
        constexpr std::size_t most_waiting_bytes = 1'000'000;
        if (waiting_.size() > most_waiting_bytes) return "the serial line is slower than what is played";
        waiting_ += frame_;
        write();
        return {};
    }
    void wait_until(Clock::time_point then) override {
        for (auto now = Clock::now(); now < then && !waiting_.empty(); now = Clock::now()) {
            ::pollfd line{port_.native_handle(), POLLOUT, 0};
            const auto wait = std::chrono::ceil<std::chrono::milliseconds>(then - now);
            if (::poll(&line, 1, static_cast<int>(wait.count())) < 0 && errno == EINTR) return;
            write();
        }
        PlaybackTarget::wait_until(then);
    }
    bool is_drained() const override { return waiting_.empty(); }

  private:
    void write() {
        while (!waiting_.empty()) {
            const auto written = ::write(port_.native_handle(), waiting_.data(), waiting_.size());
            if (written > 0) waiting_.erase(0, static_cast<std::size_t>(written));
            if (written > 0 || (written < 0 && errno == EINTR)) continue;
            if (written == 0 || errno == EAGAIN) return;
            throw OutputError(fmt::format("cannot write to {}: {}", line_.device, std::strerror(errno)));
        }
    }

    telemetry::MessageDictionary definitions_;
    telemetry::LinkEncoder encoder_;
    SerialLine line_;
    boost::asio::io_context context_;
    boost::asio::serial_port port_{context_};
    std::string frame_;
    std::string waiting_;
};

class IvyTarget : public PlaybackTarget {
  public:
    IvyTarget(std::string_view bus, bool as_aircraft)
        : as_aircraft_(as_aircraft),
          agent_(context_, {.bus = parse_ivy_bus(bus), .name = "FlightWatt play", .sends = true}) {
        agent_.start();
    }
    ~IvyTarget() override {
        try {
            agent_.stop();
            context_.run();  // what was begun ends, since all is closed
        } catch (const std::exception&) {
            // Peers that are left without a good-bye see that the line is closed.
        }
    }

    bool has_receiver(std::chrono::milliseconds timeout) override {
        for (const auto end = Clock::now() + timeout; agent_.ready_peers() == 0 && Clock::now() < end;) {
            context_.run_one_until(end);
        }
        return agent_.ready_peers() > 0;
    }
    std::string_view send(const PlayedMessage& message) override {
        const auto text = message.text;
        context_.poll();
        if (as_aircraft_) {
            agent_.send(text);
            return {};
        }
        const auto sender = text.substr(0, text.find(' '));
        if (parse_unsigned(sender)) {
            agent_.send(fmt::format("replay{}", text));
            agent_.send(fmt::format("time{} {:f}", sender, message.time_s));
        } else {
            agent_.send(text);
        }
        return {};
    }
    void wait_until(Clock::time_point then) override { context_.run_until(then); }
    bool is_drained() const override { return agent_.waiting_bytes() == 0; }

  private:
    bool as_aircraft_;
    boost::asio::io_context context_;
    IvyAgent agent_;
};

/// Lines to a new file, each written at once.
class LineTarget : public PlaybackTarget {
  public:
    explicit LineTarget(std::string name) : name_(std::move(name)) {
        register_output(name_);
        file_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
        if (file_ < 0) refuse();
        mark_written(name_);
    }
    ~LineTarget() override { ::close(file_); }

    std::string_view send(const PlayedMessage& message) override {
        line_ = fmt::format("{} {}\n", message.time, message.text);
        for (std::string_view rest = line_; !rest.empty();) {
            const auto written = ::write(file_, rest.data(), rest.size());
            if (written < 0 && errno != EINTR) refuse();
            if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
        }
        return {};
    }

  private:
    [[noreturn]] void refuse() const {
        throw OutputError(fmt::format("cannot write {}: {}", name_, std::strerror(errno)));
    }

    int file_ = -1;
    std::string name_;
    std::string line_;
};

}  // namespace

std::unique_ptr<PlaybackTarget> open_playback_target(std::string_view to, PlaybackTargetSetup setup) {
    const auto colon = to.find(':');
    const auto kind = to.substr(0, colon);
    const auto place = colon == std::string_view::npos ? std::string_view() : to.substr(colon + 1);
    if (kind == "file" && !place.empty()) return std::make_unique<LineTarget>(std::string(place));
    if (kind == "ivy" && !place.empty()) return std::make_unique<IvyTarget>(place, setup.as_aircraft);
    if (kind == "udp" && !place.empty()) return std::make_unique<UdpTarget>(place, std::move(setup));
    if (kind == "serial" && !place.empty()) return std::make_unique<SerialTarget>(place, std::move(setup));
    throw UsageError(
        fmt::format("nothing can be played to '{}': expected udp:ADDRESS:PORT, serial:DEVICE:BAUD, "
                    "ivy:ADDRESS:PORT, file:NAME.data or -",
                    to));
}

}  // namespace flightwatt::live
