#include "live/playback.h"

#include "base/error.h"
#include "base/number.h"
#include "live/sources/datagrams.h"
#include "live/sources/player.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"
#include "telemetry/link_encoder.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::chrono::milliseconds max_wait{50};  // between two calls of stop()

/// Waits in short steps; false: stopped.
bool wait_for(Clock::time_point then, const std::function<bool()>& stop) {
    for (;;) {
        if (stop()) return false;
        const auto now = Clock::now();
        if (now >= then) return true;
        std::this_thread::sleep_until(std::min(then, now + max_wait));
    }
}

/// Throws InputError where the lengths of the messages differ from their definitions.
void play_binary(const telemetry::BinaryLog& log, Player& player) {
    LinkReader reader(player, std::make_shared<const telemetry::MessageDictionary>(*log.messages), log.framing,
                      link_version(log));
    play_bytes(log.bytes, reader, player);
    if (!player.is_stopped()) require_matching_lengths(reader.counts(), log);
}

/// Sends messages as link frames, each in a datagram.
class UdpTarget {
  public:
    UdpTarget(std::string_view to, telemetry::MessageDictionary definitions, telemetry::LinkVersion version)
        : definitions_(std::move(definitions)), encoder_(definitions_, version), datagrams_(to) {}

    std::string_view send(const IncomingMessage& message) {
        frame_.clear();
        if (const auto reason = encoder_.append_frame(message.text, frame_); !reason.empty()) return reason;
        return datagrams_.send(frame_);
    }

  private:
    telemetry::MessageDictionary definitions_;
    telemetry::LinkEncoder encoder_;
    std::string frame_;
    Datagrams datagrams_;
};

}  // namespace

void Player::push(IncomingMessage message) {
    if (!message.time_s) return count("no time", 1);
    if (report_.stopped) return;
    const double step_s = last_s_ ? std::max(0.0, *message.time_s - *last_s_) : 0.0;
    if (step_s > max_played_gap_s) ++report_.shortened_gaps;
    report_.log_s += std::min(step_s, max_played_gap_s);
    last_s_ = message.time_s;
    const auto due = begin_ + std::chrono::duration_cast<Clock::duration>(Seconds(report_.log_s / speed_));
    report_.stopped = !wait_for(due, stop_);
    if (report_.stopped) return;
    report_.max_delay_s = std::max(report_.max_delay_s, Seconds(Clock::now() - due).count());
    const auto reason = target_(message);
    ++(reason.empty() ? report_.messages : report_.left_out[std::string(reason)]);
}

void Player::count(std::string_view reason, std::size_t times) {
    if (times > 0 && !report_.stopped) report_.left_out[std::string(reason)] += times;
}

PlaybackReport Player::end() {
    report_.played_s = Seconds(Clock::now() - begin_).count();
    return std::move(report_);
}

std::string data_line(const IncomingMessage& message) {
    const double time_s = message.time_s.value();
    const auto in_ms = fmt::format("{:.3f}", time_s);
    return fmt::format("{} {}\n", parse_number(in_ms) == time_s ? in_ms : fmt::to_string(time_s), message.text);
}

PlaybackTarget open_udp_target(std::string_view to, telemetry::MessageDictionary definitions,
                               telemetry::LinkVersion version) {
    const auto target = std::make_shared<UdpTarget>(to, std::move(definitions), version);
    return [target](const IncomingMessage& message) { return target->send(message); };
}

PlaybackReport play(const std::filesystem::path& log, double speed, const PlaybackTarget& target,
                    const std::function<bool()>& stop, const std::optional<telemetry::MessageDictionary>& definitions) {
    const auto text = telemetry::read_data_file(log);
    if (const auto autopilot = telemetry::detect_autopilot_format(text)) {
        throw InputError({log.string()},
                         fmt::format("is a log of another autopilot ({})", telemetry::to_string(*autopilot)),
                         "play it as MAVLink: --to mavlink:127.0.0.1:14550");
    }
    const auto framing = telemetry::detect_binary_framing(text);
    if (framing && !definitions) {
        throw InputError({log.string()}, "is a binary log without a .log that defines its messages",
                         "give the messages.xml or .log of the aircraft and its software version: --messages FILE");
    }
    Player player(speed, target, stop);
    if (framing) {
        play_binary({text, *framing, log, log, &*definitions}, player);
    } else {
        TextReader reader(player);
        play_bytes(text, reader, player);
    }
    return player.end();
}

}  // namespace flightwatt::live
