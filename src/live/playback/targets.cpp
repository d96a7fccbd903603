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

namespace flightwatt::live {
namespace {

using Clock = std::chrono::steady_clock;

/// Sends messages as link frames, each in a datagram; without a receiver it is lost, as over the air.
class UdpTarget : public PlaybackTarget {
  public:
    UdpTarget(std::string_view to, PlaybackTargetSetup setup)
        : definitions_(std::move(setup.definitions.value())),
          encoder_(definitions_, setup.version),
          to_(parse_udp_address(to)),
          socket_(context_, to_.protocol()) {
        socket_.set_option(boost::asio::socket_base::broadcast(true));
    }

    std::string_view send(const IncomingMessage& message) override {
        frame_.clear();
        if (const auto reason = encoder_.append_frame(message.text, frame_); !reason.empty()) return reason;
        boost::system::error_code error;
        socket_.send_to(boost::asio::buffer(frame_), to_, 0, error);
        return error && error != boost::asio::error::connection_refused ? "the network did not accept them" : "";
    }

  private:
    telemetry::MessageDictionary definitions_;
    telemetry::LinkEncoder encoder_;
    std::string frame_;
    boost::asio::ip::udp::endpoint to_;
    boost::asio::io_context context_;
    boost::asio::ip::udp::socket socket_;
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
    throw UsageError(
        fmt::format("unknown target '{}': expected udp:ADDRESS:PORT, ivy:ADDRESS:PORT, file:NAME.data or -", to));
}

}  // namespace flightwatt::live
