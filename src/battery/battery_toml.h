#pragma once

#include "base/toml_reader.h"
#include "battery/battery.h"

#include <filesystem>
#include <string>

namespace flightwatt::battery {

/// Reads a battery's file (docs/formats.md). Throws InputError for missing or unknown keys, and impossible values.
Battery read_battery(const std::filesystem::path& path);

/// Reads a battery from a table of another file, such as [battery] of a mission; throws as read_battery does.
Battery battery_from(const TomlTable& table);

/// Returns the text of a file from which read_battery reads the battery.
std::string to_toml(const Battery& battery);

}  // namespace flightwatt::battery
