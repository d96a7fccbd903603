#pragma once

#include "base/input_file.h"  // IWYU pragma: export

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace flightwatt {

/// Writes `content` to a file in the folder of `path` (or in `temporary_folder` of the same file system) and renames it
/// to `path`: a reader, or a crash, finds the old content or the new one. Through a symbolic link, its target is
/// written. A replaced file keeps its permissions and, where allowed, its owner. Devices and pipes are written
/// directly. Throws OutputError with path and cause, and UsageError as check_overwrite().
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           const std::filesystem::path& temporary_folder = {});

/// Receives the next chunk of a text.
using TextSink = std::function<void(std::string_view)>;
/// Passes a text to a sink in chunks, so that it is never in memory as a whole.
using TextWriter = std::function<void(const TextSink&)>;

/// The same for a text in chunks. `write` may be called twice.
void write_file_atomically(const std::filesystem::path& path, const TextWriter& write,
                           const std::filesystem::path& temporary_folder = {});

/// Writes all files, in folders that exist, or leaves them as they are. Throws as above.
void write_files_atomically(const std::map<std::filesystem::path, std::string>& files);

/// Gives the file `path` the content of `source`: as a second name of it (a hard link), or, where the file systems
/// cannot, as a copy. As atomically; what was at `path` is replaced. For files that are only ever replaced as a whole.
void link_or_copy_file(const std::filesystem::path& source, const std::filesystem::path& path,
                       const std::filesystem::path& temporary_folder);

/// Whether the file holds this text already. It is no input for that.
bool file_holds(const std::filesystem::path& path, std::string_view text);

/// Makes the folder and those above it. Throws OutputError.
void make_directories(const std::filesystem::path& path);

}  // namespace flightwatt
