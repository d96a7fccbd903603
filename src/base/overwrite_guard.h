#pragma once

#include <filesystem>
#include <string>

/// Registers the files that a command reads and writes, so that no result replaces an input or another result, by any
/// name or link. Active after enable_overwrite_guard(), which every stage calls. Thread-safe.
namespace flightwatt {

void enable_overwrite_guard();

/// Called for every file that is read (read_file does it). Throws UsageError if a result is to go there.
void register_input(const std::filesystem::path& path);

/// A file that the command is going to write: known early, it is refused before anything is written. `option` is
/// that of the file ("--output"); may be empty. Throws UsageError where the file has been read, or is
/// another result's too.
void register_output(const std::filesystem::path& path, const std::string& option = {});

/// Throws UsageError if the file has been read, or was written by this command before.
void check_overwrite(const std::filesystem::path& path);

/// After a file was written.
void mark_written(const std::filesystem::path& path);

/// RAII: this thread reads records of an earlier run of the program, which are not inputs, and may rewrite its own
/// files.
class OverwriteExemption {
  public:
    OverwriteExemption();
    ~OverwriteExemption();
    OverwriteExemption(const OverwriteExemption&) = delete;
    OverwriteExemption& operator=(const OverwriteExemption&) = delete;
};

}  // namespace flightwatt
