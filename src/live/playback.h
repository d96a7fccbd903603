#pragma once

#include "live/sources.h"
#include "telemetry/link_decoder.h"
#include "telemetry/message_dictionary.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// A message with its time as a line of a .data file, with its end: times have milliseconds, as the ground station
/// writes them, or as many digits as they need.
std::string data_line(const IncomingMessage& message);

/// Where a log is played to.
class PlaybackTarget {
  public:
    PlaybackTarget() = default;
    virtual ~PlaybackTarget() = default;
    PlaybackTarget(const PlaybackTarget&) = delete;
    PlaybackTarget& operator=(const PlaybackTarget&) = delete;

    /// Whether there is somebody to play to; waits for that at most so long.
    virtual bool has_receiver(std::chrono::milliseconds) { return true; }
    /// One message with its time. Returns why it cannot be sent, and an empty text else. Throws OutputError where
    /// nothing can be.
    virtual std::string_view send(const IncomingMessage& message) = 0;
    /// Until then nothing is sent.
    virtual void wait_until(std::chrono::steady_clock::time_point then);
    /// Whether all that was sent is out.
    virtual bool is_drained() const { return true; }
};

/// What a target needs beside its name.
struct PlaybackTargetSetup {
    /// Of udp: and serial: alone.
    std::optional<telemetry::MessageDictionary> definitions = {};
    telemetry::LinkVersion version = telemetry::LinkVersion::v2;
    /// Of ivy: alone: messages as the aircraft itself would say them, without their time.
    bool as_aircraft = false;
};

/// "udp:127.0.0.1:4242" (link frames, a datagram each), "serial:/dev/ttyUSB0:57600" (link frames),
/// "ivy:127.255.255.255:2010" (as Paparazzi's log player says them), "file:NAME.data" (a file that grows; none that is
/// there). Throws UsageError for another name, InputError for a bus or a device that cannot be used, OutputError for a
/// file that cannot be made.
std::unique_ptr<PlaybackTarget> open_playback_target(std::string_view to, PlaybackTargetSetup setup);

/// How a log was played.
struct PlaybackReport {
    std::size_t messages = 0;                                  ///< sent
    std::map<std::string, std::size_t, std::less<>> left_out;  ///< lines, by reason
    std::size_t shortened_gaps = 0;
    double log_s = 0.0;        ///< how much of the log, on its clock
    double played_s = 0.0;     ///< in how long
    double max_delay_s = 0.0;  ///< the most that a message was behind its time
    bool stopped = false;
};

/// Gaps of a log that are longer are played as so long: nobody waits for the clock that was set between them.
inline constexpr double max_played_gap_s = 600.0;

/// Plays the messages of a log, text or binary (compressed or not), in their own time, `speed` times as fast, until its
/// end or until `stop` says so. Where the log's clock goes back it goes on at once. `definitions`: of a binary log's
/// messages. Throws InputError for a log that cannot be read.
PlaybackReport play(const std::filesystem::path& log, double speed, PlaybackTarget& target,
                    const std::function<bool()>& stop,
                    const std::optional<telemetry::MessageDictionary>& definitions = {});

}  // namespace flightwatt::live
