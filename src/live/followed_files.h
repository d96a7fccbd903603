#pragma once

#include "live/sources.h"
#include "telemetry/message_dictionary.h"

#include <filesystem>
#include <memory>

/// Telemetry from files that grow. Opening throws InputError for a file that cannot be opened. A file that is truncated
/// or replaced is read from its beginning.
namespace flightwatt::live {

/// Opens the standard input for .data lines, until it is closed.
std::unique_ptr<MessageSource> open_standard_input();

/// Opens a .data file, which is read from its beginning while the ground station appends to it.
std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path);

/// Opens a .tlog that a ground station is writing.
std::unique_ptr<MessageSource> follow_tlog(const std::filesystem::path& path);

/// Opens a binary log that is being written: SD card (with frame times), or capture of a link or an XBee.
std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions);

}  // namespace flightwatt::live
