#pragma once

#include <filesystem>
#include <string_view>

namespace flightwatt::fuzz {

/// What a target tries with any bytes: whatever they are, it ends soon, by itself or by one of the errors that have an
/// exit code. Each target defines it.
void run(std::string_view bytes);

/// A file of the bytes, for what reads files: always the same, so only one at a time. `name` decides its ending.
std::filesystem::path as_file(std::string_view bytes, const char* name);

}  // namespace flightwatt::fuzz
