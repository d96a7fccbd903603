#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::telemetry {

/// What gzip, bzip2, xz or zstd packed (told by the first bytes); std::nullopt for anything else. `file` is named in
/// errors. Throws InputError for broken compression, and for more than `max_bytes` once they are there: what a small
/// file unpacks to may have no end.
std::optional<std::string> decompressed(std::string_view bytes, const std::filesystem::path& file,
                                        std::size_t max_bytes);

}  // namespace flightwatt::telemetry
