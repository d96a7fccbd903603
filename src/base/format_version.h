#pragma once

#include "base/toml_reader.h"

#include <string>

namespace flightwatt {

/// Version of the file formats that FlightWatt writes, and the newest that it reads.
inline constexpr int format_version = 1;

/// The line of TOML that says so: "format = 1\n".
std::string format_line();

/// Checks `format` of a file of ours, which may be absent (files of version 0.1 have none). Throws InputError
/// for a format that is newer than this program, or is none.
void require_known_format(const TomlTable& root);

}  // namespace flightwatt
