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

/// A message as a line of a .data file, with its break. Times have milliseconds, as the ground station writes them, or
/// as many digits as necessary.
std::string data_line(const IncomingMessage& message);

/// Destination of a played log.
class PlaybackTarget {
  public:
    PlaybackTarget() = default;
    virtual ~PlaybackTarget() = default;
    PlaybackTarget(const PlaybackTarget&) = delete;
    PlaybackTarget& operator=(const PlaybackTarget&) = delete;

    /// Waits up to the given time for a receiver; false without one.
    virtual bool has_receiver(std::chrono::milliseconds) { return true; }
    /// Sends a message that has a time. Returns the reason if it cannot be sent, else an empty text. Throws OutputError
    /// where no message can be sent.
    virtual std::string_view send(const IncomingMessage& message) = 0;
    virtual void wait_until(std::chrono::steady_clock::time_point then);
    /// Whether no sent message waits for transmission.
    virtual bool is_drained() const { return true; }
};

struct PlaybackTargetSetup {
    std::optional<telemetry::MessageDictionary> definitions = {};  ///< for udp:
    telemetry::LinkVersion version = telemetry::LinkVersion::v2;
    bool as_aircraft = false;  ///< for ivy: messages as the aircraft sends them, without their time
};

/// "udp:127.0.0.1:4242" (a link frame in each datagram), "ivy:127.255.255.255:2010" (a replay as by Paparazzi's log
/// player), "file:NAME.data" (a new file that grows). Throws UsageError for another name, InputError for a bus that
/// cannot be opened, OutputError for the file.
std::unique_ptr<PlaybackTarget> open_playback_target(std::string_view to, PlaybackTargetSetup setup);

struct PlaybackReport {
    std::size_t messages = 0;                                  ///< sent
    std::map<std::string, std::size_t, std::less<>> left_out;  ///< lines, by reason
    std::size_t shortened_gaps = 0;
    double log_s = 0.0;        ///< played time of the log, on its clock
    double played_s = 0.0;     ///< duration
    double max_delay_s = 0.0;  ///< of a message after its due time
    bool stopped = false;
};

/// Longer gaps of a log are shortened to this: they are mostly steps of its clock.
inline constexpr double max_played_gap_s = 600.0;

/// Plays a log, text or binary (compressed or not), at `speed` times its own speed until its end or until `stop`
/// returns true. Where the log's clock goes back, the next message follows at once. `definitions`: of the messages of a
/// binary log. Throws InputError for a log that cannot be read.
PlaybackReport play(const std::filesystem::path& log, double speed, PlaybackTarget& target,
                    const std::function<bool()>& stop,
                    const std::optional<telemetry::MessageDictionary>& definitions = {});

}  // namespace flightwatt::live
