#pragma once

#include "base/input_file.h"  // IWYU pragma: export

#include <filesystem>
#include <functional>
#include <string_view>

namespace flightwatt {

/// Writes `content` to a file beside `path` (or in `temporary_folder`, a folder of the same file system) and renames it
/// over `path`, so that a reader (or a crash) sees the old content or the new one, never a part. Where `path` is a
/// symbolic link, what it points to is written. A file that is replaced keeps its permissions, and its owner where that
/// is allowed; a new one follows the umask. Devices and pipes are written directly. Throws OutputError naming the path
/// and the cause, and UsageError where that would lose what the command has read or written (overwrite_guard.h).
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           const std::filesystem::path& temporary_folder = {});

/// Takes the next piece of a text.
using TextSink = std::function<void(std::string_view)>;
/// Hands a text to a sink piece by piece, so that it need not lie in memory as a whole.
using TextWriter = std::function<void(const TextSink&)>;

/// The same of a text in pieces. `write` may be called twice.
void write_file_atomically(const std::filesystem::path& path, const TextWriter& write,
                           const std::filesystem::path& temporary_folder = {});

/// Gives the file `path` the content of `source`: as a second name of it (a hard link), or, where the file systems
/// cannot, as a copy. As atomically; what was at `path` is replaced. For files that are only ever replaced as a whole.
void link_or_copy_file(const std::filesystem::path& source, const std::filesystem::path& path,
                       const std::filesystem::path& temporary_folder);

/// Whether the file holds this text already. It is no input for that.
bool file_holds(const std::filesystem::path& path, std::string_view text);

/// The name of a file that write_file_atomically has not renamed yet: ".flightwatt-" and sixteen hexadecimal digits.
bool is_temporary_name(std::string_view name);

/// Makes the folder and those above it. Throws OutputError.
void make_directories(const std::filesystem::path& path);

}  // namespace flightwatt
