#pragma once

#include "live/sources.h"
#include "telemetry/link_decoder.h"
#include "telemetry/message_dictionary.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// Returns a message as a line of a .data file, with its line break. Its time has milliseconds, as the ground station
/// writes it, or as many digits as necessary.
std::string data_line(const IncomingMessage& message);

/// Sends a message of a played log, which has a time. Returns an empty text, or the reason why it cannot be sent.
using PlaybackTarget = std::function<std::string_view(const IncomingMessage&)>;

/// Returns a target that sends link frames, one in each datagram, to an address: "127.0.0.1:4242". Throws UsageError
/// for another text.
PlaybackTarget open_udp_target(std::string_view to, telemetry::MessageDictionary definitions,
                               telemetry::LinkVersion version = telemetry::LinkVersion::v2);

/// How a log is played.
struct PlaybackOptions {
    double speed = 1.0;         ///< relative to the log's own time
    double from_s = 0.0;        ///< what is played begins so long after the log's first message
    double loss_percent = 0.0;  ///< share of the messages that are drawn to be lost, always the same ones
    double delay_s = 0.0;       ///< each is sent later by a time drawn from 0 to this: later ones may overtake it
};

/// What was played, and how exactly.
struct PlaybackReport {
    std::size_t messages = 0;                                  ///< messages sent
    std::size_t lost = 0;                                      ///< messages that were drawn to be lost
    std::map<std::string, std::size_t, std::less<>> left_out;  ///< lines that were not sent, by reason
    std::size_t shortened_gaps = 0;                            ///< gaps of more than max_played_gap_s
    double log_s = 0.0;                                        ///< played time of the log, on its clock
    double played_s = 0.0;                                     ///< duration of the playback
    double max_delay_s = 0.0;                                  ///< largest delay of a message
    bool stopped = false;                                      ///< ended by `stop`
};

/// Length to which longer gaps of a log are shortened: they are mostly steps of its clock.
inline constexpr double max_played_gap_s = 600.0;

/// Plays a log, text or binary (compressed or not), until its end or until `stop` returns true. Where the log's clock
/// goes back, the next message follows at once. `definitions` define the messages
/// of a binary log. Throws InputError for a log that cannot be read.
PlaybackReport play(const std::filesystem::path& log, const PlaybackOptions& options, const PlaybackTarget& target,
                    const std::function<bool()>& stop,
                    const std::optional<telemetry::MessageDictionary>& definitions = {});

/// Returns a target that sends MAVLink's packets of messages, one in each datagram, to an address: "127.0.0.1:14550".
/// Throws UsageError for another text.
PlaybackTarget open_mavlink_target(std::string_view to);

/// Plays a log of any kind as MAVLink, as play() does: the packets of a .tlog; of other logs those that the aircraft would
/// send, by its tracks. Of several aircraft `aircraft` names one. Throws InputError for a log that cannot be read.
PlaybackReport play_as_mavlink(const std::filesystem::path& log, const PlaybackOptions& options,
                               const PlaybackTarget& target, const std::function<bool()>& stop,
                               const std::optional<std::string>& aircraft = {});

}  // namespace flightwatt::live
