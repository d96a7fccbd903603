#pragma once

#include "base/input_file.h"  // IWYU pragma: export

#include <filesystem>
#include <string_view>

namespace flightwatt {

/// Writes `content` to a file beside `path` and renames it over `path`, so that a reader (or a crash) sees
/// the old content or the new one, never a part. Throws OutputError naming the path and the cause.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Makes the folder and those above it. Throws OutputError.
void make_directories(const std::filesystem::path& path);

}  // namespace flightwatt
