#pragma once

#include "live/sources.h"
#include "telemetry/message_dictionary.h"

#include <memory>
#include <string_view>

/// Telemetry received by radio or network, by a thread of its own. Opening throws UsageError for an invalid name and
/// InputError for a link that cannot be opened. A message without a time gets its arrival time: seconds since opening
/// times `clock_factor` (60 for a log that is played at 60 times its speed).
namespace flightwatt::live {

/// Opens the Ivy bus "127.255.255.255:2010", for messages of aircraft, and replays with their own times.
std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor = 1.0);

/// Opens a UDP port for link frames: "4242", or "127.0.0.1:4242" for one local address.
std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor = 1.0);

/// Opens a serial line for link frames or XBee packets: "/dev/ttyUSB0:57600"; default 57600 baud.
std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor = 1.0);

/// Opens a link of MAVLink: "udp:14550" (a port of this machine, or ADDRESS:PORT), "udpout:HOST:PORT" (to a program that
/// sends to those from which it hears: a heartbeat is sent once a second), "tcp:HOST:PORT", or a serial line
/// "/dev/ttyUSB0:57600". Nothing else is sent. A lost connection is opened again.
std::unique_ptr<MessageSource> open_mavlink(std::string_view link, double clock_factor = 1.0);

}  // namespace flightwatt::live
