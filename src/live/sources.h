#pragma once

#include "live/source.h"
#include "telemetry/message_dictionary.h"

#include <filesystem>
#include <memory>
#include <string_view>

/// Sources by what they read. A link is received in a thread of its own; times that its messages lack are those of
/// their arrival: seconds since the source was opened, times `clock_factor` (a log that is played 60 times as fast:
/// 60). Opening throws UsageError for an invalid name, InputError for what cannot be opened. A file that gets shorter,
/// or another that takes its name, is read from its beginning.
namespace flightwatt::live {

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
