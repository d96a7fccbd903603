#pragma once

#include "base/toml_reader.h"

#include <filesystem>
#include <string_view>

namespace flightwatt::mission {

/// Returns the file that a key names, relative to the mission file. Throws InputError at the key if it cannot be read.
std::filesystem::path named_file(const TomlTable& table, std::string_view key);

}  // namespace flightwatt::mission
