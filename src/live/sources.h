#pragma once

#include "telemetry/message_dictionary.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Sources of the telemetry of a flight in progress.
namespace flightwatt::live {

/// A received telemetry message: a line of a .data file with its time split off.
struct IncomingMessage {
    std::optional<double>
        time_s;        ///< on the source's clock (line, card frame, replay); absent: the arrival time is to be used
    std::string text;  ///< "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97": sender, name, fields
    bool is_after_restart = false;    ///< first message after a file was replaced or a link reopened
    std::vector<double> values = {};  ///< of the fields, NaN for text and arrays; empty: they are in `text`
    std::string packet = {};  ///< MAVLink's bytes; its `text` has sender and name, `values` the requested fields
    std::optional<double> begin_unix_s = {};  ///< Unix time at 0 of the source's clock, as a recording states it
};

/// Counters of a source; they never decrease.
struct SourceReport {
    std::size_t messages = 0;
    std::map<std::string, std::size_t, std::less<>> unusable;  ///< lines, frames, bytes by reason
    std::size_t restarts = 0;

    /// Adds to the count of a reason.
    void count(std::string_view reason, std::size_t times);
};

/// A source of telemetry, for use by one thread. After opening, failures (missing file, unplugged device, invalid
/// input) are counted and do not throw.
class MessageSource {
  public:
    MessageSource() = default;
    virtual ~MessageSource() = default;
    MessageSource(const MessageSource&) = delete;
    MessageSource& operator=(const MessageSource&) = delete;

    /// Appends the messages received, at most a few thousand a call; waits up to `timeout` for the first. A signal
    /// ends the wait.
    virtual void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) = 0;
    /// Returns whether no more messages will follow: standard input was closed.
    virtual bool at_end() const { return false; }
    /// Sends bytes back over the link: to those from which it heard, or to the other end. Bytes that cannot be sent at
    /// once are dropped. Returns false for a source that is no link of both directions.
    virtual bool send(std::string_view) { return false; }
    /// Returns the counters since opening.
    virtual const SourceReport& report() const = 0;
};

/// Parses a .data line; std::nullopt if its first word is not a finite number or no message follows it.
std::optional<IncomingMessage> parse_message_line(std::string_view line);

}  // namespace flightwatt::live
