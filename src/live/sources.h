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

/// A flight that is still in the air: where its telemetry comes from, what is known of it, what is to be expected.
namespace flightwatt::live {

/// A telemetry message as it came in: a line of a .data file, its time apart.
struct IncomingMessage {
    /// [s] on a clock of the source's own: a line's, a card frame's, a replay's. None: when it arrives counts.
    std::optional<double> time_s;
    std::string text;  ///< "20 ENERGY 57 11.62 1.64 19.1 0.08 0.97": sender, name, fields
    /// The first since its source began anew (a file that was replaced, a link that was opened again): its clock may
    /// have begun anew, too.
    bool is_after_restart = false;
    /// Of the fields, NaN for what is no single number; empty where `text` alone has them.
    std::vector<double> values = {};
};

/// What a source has seen beside messages, for warnings and the page. Counts only grow.
struct SourceReport {
    std::size_t messages = 0;
    std::map<std::string, std::size_t, std::less<>> unusable;  ///< lines, frames, bytes by reason
    std::size_t restarts = 0;

    void count(std::string_view reason, std::size_t times);
};

/// Where telemetry comes from. One thread calls it. What goes wrong after it was opened (a file that is gone for a
/// while, a device that is unplugged, garbage) is counted and waited out, not thrown.
class MessageSource {
  public:
    MessageSource() = default;
    virtual ~MessageSource() = default;
    MessageSource(const MessageSource&) = delete;
    MessageSource& operator=(const MessageSource&) = delete;

    /// Waits for messages, at most so long, and appends those that have come in: at most a few thousand a call, so that
    /// whoever asks can look up in between. A signal ends the wait early.
    virtual void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) = 0;
    /// Nothing will come any more: standard input was closed.
    virtual bool at_end() const { return false; }
    /// "following logs/20_07_03.data"
    virtual std::string description() const = 0;
    virtual const SourceReport& report() const = 0;
};

/// A .data line as a message: its first word is the time. std::nullopt where that is no finite number, or nothing
/// stands behind it.
std::optional<IncomingMessage> message_of_line(std::string_view line);

// Sources by what they read. A link is received in a thread of its own; times that its messages lack are those of
// their arrival: seconds since the source was opened, times `clock_factor` (a log that is played 60 times as fast:
// 60). Opening throws UsageError for an invalid name, InputError for what cannot be opened. A file that gets shorter,
// or another that takes its name, is read from its beginning.

/// The Ivy bus "127.255.255.255:2010": what aircraft say, and what a log player says of them, with a replay's own
/// times.
std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor = 1.0);

/// Link frames that come in on a UDP port: "4242", or "127.0.0.1:4242" for those to this address alone.
std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor = 1.0);

/// Link frames, or an XBee's packets, on a serial line: "/dev/ttyUSB0:57600"; without a speed 57600.
std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor = 1.0);

/// The .data lines of the standard input, until it is closed.
std::unique_ptr<MessageSource> standard_input();

/// A .data file from its beginning, and what is written to it from then on, as the ground station does.
std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path);

/// A binary log that is being written: an SD card's, with the times of its frames, or a capture of a link or an XBee.
std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions);

}  // namespace flightwatt::live
