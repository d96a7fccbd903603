#include "base/error.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "live/playback.h"
#include "live/recorder.h"
#include "live/sources/endpoints.h"
#include "live/sources/ivy_agent.h"
#include "telemetry/link_encoder.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include <boost/asio.hpp>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

using Clock = std::chrono::steady_clock;

/// Sends messages as link frames.
class FrameTarget : public PlaybackTarget {
  public:
    explicit FrameTarget(PlaybackTargetSetup setup)
        : definitions_(std::move(setup.definitions.value())), encoder_(definitions_, setup.version) {}

    std::string_view send(const IncomingMessage& message) override {
        frame_.clear();
        const auto reason = encoder_.append_frame(message.text, frame_);
        return reason.empty() ? send_frame(frame_) : reason;
    }

  protected:
    /// Returns the reason if it is not sent, else an empty text.
    virtual std::string_view send_frame(std::string_view frame) = 0;

  private:
    telemetry::MessageDictionary definitions_;
    telemetry::LinkEncoder encoder_;
    std::string frame_;
};

/// A datagram each; without a receiver it is lost, as over the air.
class UdpTarget : public FrameTarget {
  public:
    UdpTarget(std::string_view to, PlaybackTargetSetup setup)
        : FrameTarget(std::move(setup)), to_(parse_udp_address(to)), socket_(context_, to_.protocol()) {
        socket_.set_option(boost::asio::socket_base::broadcast(true));
    }

  private:
    std::string_view send_frame(std::string_view frame) override {
        boost::system::error_code error;
        socket_.send_to(boost::asio::buffer(frame), to_, 0, error);
        return error && error != boost::asio::error::connection_refused ? "the network did not accept them" : "";
    }

    boost::asio::ip::udp::endpoint to_;
    boost::asio::io_context context_;
    boost::asio::ip::udp::socket socket_;
};

/// On a serial line, which asio opens non-blocking. A frame that it does not accept within a second is left out.
class SerialTarget : public FrameTarget {
  public:
    SerialTarget(std::string_view to, PlaybackTargetSetup setup)
        : FrameTarget(std::move(setup)), line_(parse_serial_line(to)) {
        register_output(line_.device);
        require_serial_line(line_, port_);
    }

  private:
    std::string_view send_frame(std::string_view frame) override {
        constexpr int max_ms = 1000;
        while (!frame.empty()) {
            ::pollfd line{port_.native_handle(), POLLOUT, 0};
            if (::poll(&line, 1, max_ms) == 0) return "the serial line is slower than the log";
            const auto written = ::write(port_.native_handle(), frame.data(), frame.size());
            if (written > 0) frame.remove_prefix(static_cast<std::size_t>(written));
            if (written < 0 && errno != EINTR && errno != EAGAIN)
                throw OutputError(fmt::format("cannot write to {}: {}", line_.device, std::strerror(errno)));
        }
        return {};
    }

    SerialLine line_;
    boost::asio::io_context context_;
    boost::asio::serial_port port_{context_};
};

class IvyTarget : public PlaybackTarget {
  public:
    IvyTarget(std::string_view bus, bool as_aircraft)
        : as_aircraft_(as_aircraft),
          agent_(context_, {.bus = parse_ivy_bus(bus), .name = "FlightWatt play", .sends = true}) {}

    bool has_receiver(std::chrono::milliseconds timeout) override {
        for (const auto end = Clock::now() + timeout; agent_.ready_peers() == 0 && Clock::now() < end;) {
            context_.run_one_until(end);
        }
        return agent_.ready_peers() > 0;
    }
    std::string_view send(const IncomingMessage& message) override {
        const std::string_view text = message.text;
        context_.poll();
        if (as_aircraft_) {
            agent_.send(text);
            return {};
        }
        const auto sender = text.substr(0, text.find(' '));
        if (parse_unsigned(sender)) {
            agent_.send(fmt::format("replay{}", text));
            agent_.send(fmt::format("time{} {:f}", sender, *message.time_s));
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

/// Lines to a new file, flushed one by one.
class LineTarget : public PlaybackTarget {
  public:
    explicit LineTarget(std::string name) : name_(std::move(name)) {
        register_output(name_);
        if (!make_new_file(name_)) throw OutputError(fmt::format("cannot write {}: {}", name_, std::strerror(EEXIST)));
        file_.open(name_, std::ios::app | std::ios::binary);
        mark_written(name_);
    }
    std::string_view send(const IncomingMessage& message) override {
        file_ << data_line(message) << std::flush;
        if (!file_) throw OutputError(fmt::format("cannot write {}: {}", name_, std::strerror(errno)));
        return {};
    }

  private:
    std::string name_;
    std::ofstream file_;
};

}  // namespace

std::unique_ptr<PlaybackTarget> open_playback_target(std::string_view to, PlaybackTargetSetup setup) {
    const auto colon = to.find(':');
    const auto kind = to.substr(0, colon);
    const auto where = colon == std::string_view::npos ? std::string_view() : to.substr(colon + 1);
    if (kind == "file" && !where.empty()) return std::make_unique<LineTarget>(std::string(where));
    if (kind == "ivy" && !where.empty()) return std::make_unique<IvyTarget>(where, setup.as_aircraft);
    if (kind == "udp" && !where.empty()) return std::make_unique<UdpTarget>(where, std::move(setup));
    if (kind == "serial" && !where.empty()) return std::make_unique<SerialTarget>(where, std::move(setup));
    throw UsageError(
        fmt::format("unknown target '{}': expected udp:ADDRESS:PORT, serial:DEVICE:BAUD, "
                    "ivy:ADDRESS:PORT, file:NAME.data or -",
                    to));
}

}  // namespace flightwatt::live
