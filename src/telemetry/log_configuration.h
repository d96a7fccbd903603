#pragma once

#include "telemetry/log_notes.h"
#include "telemetry/message_definition.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace flightwatt::telemetry {

/// One aircraft of the configuration that a .log embeds.
struct AircraftConfiguration {
    std::string id;
    std::string name;
    std::optional<double> ground_altitude_m;
    std::map<int, std::string> block_names;
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::string firmware = {};  ///< "fixedwing", "rotorcraft", "rover"; empty if unknown
};

/// Contents of a Paparazzi .log: message definitions by name, and aircraft by id.
struct LogConfiguration {
    std::filesystem::path file;
    std::optional<double> time_of_day_s;  ///< Unix time at which the log's own seconds begin
    std::map<std::string, MessageDefinition, std::less<>> messages;
    std::map<std::string, AircraftConfiguration> aircraft;
};

/// Maximum size of a .log; the configuration of an aircraft has about one MB.
inline constexpr std::size_t max_log_configuration_bytes = 16'000'000;

/// Reads a .log, from a file or its `text`. Such files are often not well-formed XML ("&&", bare "<", escaped quotes in
/// flight plans), so only the <protocol> element and single tags of the aircraft are read as XML. Throws InputError if
/// there is no <protocol>, it has no message, or it cannot be read.
LogConfiguration read_log_configuration(const std::filesystem::path& path);
LogConfiguration parse_log_configuration(const std::string& text, const std::filesystem::path& file);

/// Returns the .log of a log ("X.data", "X.data.gz", "X_SD.data", a card's "X.LOG"): "X.log" in the same folder, else
/// an X.LOG that is XML; never the log itself. A .log that cannot be read (a folder without permission, a link loop) is
/// returned, so that reading it reports the reason.
std::optional<std::filesystem::path> find_log_file(const std::filesystem::path& data_file);

/// Returns whether a file begins like XML: an X.LOG may be an SD card's log or the definitions of X.tlm.
bool begins_as_xml(const std::filesystem::path& path);

/// Returns the name of a log without folder and endings: "20_07_03__12_17_45" for "logs/20_07_03__12_17_45.data.gz".
std::string flight_name(const std::filesystem::path& data_file);

}  // namespace flightwatt::telemetry
