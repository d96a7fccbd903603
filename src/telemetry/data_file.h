#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace flightwatt::telemetry {

/// Default limit on the unpacked size of a compressed log: about ten hours of flight. Reading takes up to nine times as
/// much memory.
inline constexpr std::size_t default_max_log_bytes = 100'000'000;

/// Returns the content of a log, decompressed (.gz, .bz2, .xz, .zst, recognised by content). Throws InputError for a
/// missing file, a folder, an empty file, a ZIP archive, broken compression, a file that is cut while it is read, one
/// that unpacks to more than `max_bytes`, and one with more than that in blocks of zeros.
std::string read_data_file(const std::filesystem::path& path, std::size_t max_bytes = default_max_log_bytes);

/// Returns the first bytes of a regular file, at most 64 KB; empty for one that cannot be read.
std::string beginning_of_file(const std::filesystem::path& path);

}  // namespace flightwatt::telemetry
