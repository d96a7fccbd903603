#pragma once

#include "telemetry/message_dictionary.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// A flight in progress: sources of its telemetry, its state, its prediction.
namespace flightwatt::live {

/// A received telemetry message: a line of a .data file with its time split off.
struct IncomingMessage {
    std::optional<double> time_s;     ///< on the source's clock (line, card frame, replay); none: use the arrival time
    std::string text;                 ///< "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97": sender, name, fields
    bool is_after_restart = false;    ///< first message after a file was replaced or a link reopened
    std::vector<double> values = {};  ///< of the fields, NaN for text and arrays; empty: `text` contains the fields
};

/// Counters of a source; they never decrease.
struct SourceReport {
    std::size_t messages = 0;
    std::map<std::string, std::size_t, std::less<>> unusable;  ///< lines, frames, bytes by reason
    std::size_t restarts = 0;

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
    /// No more messages will follow: standard input was closed.
    virtual bool at_end() const { return false; }
    virtual const SourceReport& report() const = 0;
};

/// Parses a .data line. std::nullopt where the first word is not a finite number or no message follows it.
std::optional<IncomingMessage> message_of_line(std::string_view line);

// Opening throws UsageError for an invalid name and InputError for a source that cannot be opened. Links are received
// by a thread of their own. Messages without a time get their arrival time: seconds since opening times `clock_factor`
// (60 for a log that is played at 60 times its speed). A file that is truncated or replaced is read from its beginning.

/// The Ivy bus "127.255.255.255:2010": messages of aircraft, and replays with their own times.
std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor = 1.0);

/// Link frames on a UDP port: "4242", or "127.0.0.1:4242" for one local address.
std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor = 1.0);

/// Link frames or XBee packets on a serial line: "/dev/ttyUSB0:57600"; default 57600 baud.
std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor = 1.0);

/// .data lines of the standard input, until it is closed.
std::unique_ptr<MessageSource> standard_input();

/// A .data file from its beginning, while the ground station appends to it.
std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path);

/// A binary log that is being written: SD card (with frame times), or capture of a link or an XBee.
std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions);

}  // namespace flightwatt::live
