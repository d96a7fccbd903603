#include "live/playback.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "flight/load_flight.h"
#include "flight/select.h"
#include "flight/telemetry_series.h"
#include "live/sources/datagrams.h"
#include "live/sources/flight_packets.h"
#include "live/sources/message_readers.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"
#include "telemetry/link_encoder.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <random>
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

/// Sends the messages of a log to a target when they are due.
class Player final : public MessageSink {
  public:
    Player(const PlaybackOptions& options, const PlaybackTarget& target, const std::function<bool()>& stop)
        : options_(options), target_(target), stop_(stop) {}

    bool is_stopped() const { return report_.stopped; }

    void push(IncomingMessage message) override {
        if (!message.time_s) return count("no time", 1);
        if (report_.stopped) return;
        if (!first_s_) first_s_ = message.time_s;
        if (!last_s_ && *message.time_s < *first_s_ + options_.from_s) return;
        const double step_s = last_s_ ? std::max(0.0, *message.time_s - *last_s_) : 0.0;
        if (step_s > max_played_gap_s) ++report_.shortened_gaps;
        report_.log_s += std::min(step_s, max_played_gap_s);
        last_s_ = message.time_s;
        if (drawn() < options_.loss_percent) return void(++report_.lost);
        send_waiting(report_.log_s);
        const double delay_s = options_.delay_s > 0.0 ? units::amount_from_percent(options_.delay_s, drawn()) : 0.0;
        waiting_.emplace(report_.log_s + delay_s, std::move(message));
        send_waiting(report_.log_s);
    }

    void count(std::string_view reason, std::size_t times) override {
        if (times > 0 && !report_.stopped) report_.left_out[std::string(reason)] += times;
    }

    PlaybackReport end() {
        send_waiting(std::numeric_limits<double>::infinity());
        report_.played_s = Seconds(Clock::now() - begin_).count();
        return std::move(report_);
    }

  private:
    /// A number from 0 to 100, the same ones in each run.
    double drawn() {
        constexpr double range = 4'294'967'296.0;  // of mt19937
        return units::percent_per_whole * static_cast<double>(random_()) / range;
    }

    /// Sends those that are due until a time since the begin, on the log's clock.
    void send_waiting(double until_s) {
        while (!waiting_.empty() && waiting_.begin()->first <= until_s && !report_.stopped) {
            const auto next = waiting_.extract(waiting_.begin());
            const auto due = begin_ + std::chrono::duration_cast<Clock::duration>(Seconds(next.key() / options_.speed));
            report_.stopped = !wait_for(due, stop_);
            if (report_.stopped) return;
            report_.max_delay_s = std::max(report_.max_delay_s, Seconds(Clock::now() - due).count());
            const auto reason = target_(next.mapped());
            ++(reason.empty() ? report_.messages : report_.left_out[std::string(reason)]);
        }
    }

    PlaybackOptions options_;
    const PlaybackTarget& target_;
    const std::function<bool()>& stop_;
    PlaybackReport report_;
    std::optional<double> first_s_;                   ///< of the log, on its clock
    std::optional<double> last_s_;                    ///< of the message before
    std::multimap<double, IncomingMessage> waiting_;  ///< by when they are sent, on the log's clock since the begin
    std::mt19937 random_;
    Clock::time_point begin_ = Clock::now();
};

/// Passes on the messages of one sender.
class OneSender final : public MessageSink {
  public:
    OneSender(MessageSink& sink, const std::string& sender) : sink_(sink), start_(sender + " ") {}
    void push(IncomingMessage message) override {
        if (message.text.starts_with(start_)) sink_.push(std::move(message));
    }
    void count(std::string_view reason, std::size_t times) override { sink_.count(reason, times); }

  private:
    MessageSink& sink_;
    std::string start_;
};

/// In chunks, so that a stopped player ends soon.
template <typename Reader>
void play_bytes(std::string_view bytes, Reader& reader, const Player& player) {
    constexpr std::size_t chunk = 4096;
    for (auto rest = bytes; !rest.empty() && !player.is_stopped(); rest.remove_prefix(std::min(chunk, rest.size())))
        reader.push(rest.substr(0, chunk));
    if (!player.is_stopped()) reader.flush();
}

/// Throws InputError where the lengths of the messages differ from their definitions.
void play_binary(const telemetry::BinaryLog& log, Player& player) {
    LinkReader reader(player, std::make_shared<const telemetry::MessageDictionary>(*log.messages), log.framing,
                      link_version(log));
    play_bytes(log.bytes, reader, player);
    if (!player.is_stopped()) require_matching_lengths(reader.counts(), log);
}

/// The number of an aircraft of several in a .tlog, which ends its name: "ArduCopter 2"; empty for the only one.
std::string system_of(const flight::FlightSeries& series) {
    const auto& name = series.aircraft_name;
    const auto number = name.substr(name.rfind(' ') + 1);
    return parse_unsigned(number) ? number : "";
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

PlaybackReport play(const std::filesystem::path& log, const PlaybackOptions& options, const PlaybackTarget& target,
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
    Player player(options, target, stop);
    if (framing) {
        play_binary({text, *framing, log, log, &*definitions}, player);
    } else {
        TextReader reader(player);
        play_bytes(text, reader, player);
    }
    return player.end();
}

PlaybackTarget open_mavlink_target(std::string_view to) {
    const auto target = std::make_shared<Datagrams>(to);
    return [target](const IncomingMessage& message) { return target->send(message.packet); };
}

PlaybackReport play_as_mavlink(const std::filesystem::path& log, const PlaybackOptions& options,
                               const PlaybackTarget& target, const std::function<bool()>& stop,
                               const std::optional<std::string>& aircraft) {
    const flight::FlightFile file(log);
    if (file.autopilot() == telemetry::AutopilotFormat::tlog) {
        const auto system = aircraft ? system_of(choose_aircraft(read_candidates(file, aircraft))) : std::string();
        Player player(options, target, stop);
        OneSender of_system(player, system);
        MavlinkReader reader(system.empty() ? static_cast<MessageSink&>(player) : of_system,
                             std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages()), true);
        play_bytes(file.text(), reader, player);
        return player.end();
    }
    const auto series = choose_aircraft(read_candidates(file, aircraft));
    const auto data = select_tracks(series);
    auto packets = flight_packets(data);
    Player player(options, target, stop);  // its clock begins
    std::size_t too_high = 0;
    for (std::size_t i = 0; i < data.power_w.time_s.size(); ++i)
        if (data.power_w.value[i] > max_mavlink_current_a * value_at(data.voltage_v, data.power_w.time_s[i]))
            ++too_high;
    player.count("currents above 327.67 A, the limit of MAVLink's BATTERY_STATUS", too_high);
    for (auto& message : packets)
        if (!player.is_stopped()) player.push(std::move(message));
    return player.end();
}

}  // namespace flightwatt::live
