#pragma once

#include "live/source.h"
#include "telemetry/message_dictionary.h"

#include <filesystem>
#include <memory>
#include <string_view>

/// Links as sources. Each receives in a thread of its own; times that messages lack are those of their arrival: seconds
/// since the source was opened, times `clock_factor` (a log that is played 60 times as fast: 60). What was never right
/// throws when it is opened: UsageError for a name that is none, InputError for what cannot be opened.
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

/// A binary log that is being written: an SD card's, with the times of its frames, or a capture of a link or an XBee.
/// Where the file gets shorter or another takes its name, that is read from its beginning.
std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions);

}  // namespace flightwatt::live
