#pragma once

#include <filesystem>
#include <string>

/// Which files this command reads and which it writes, so that no result replaces what it was made from, by whatever
/// name or link. Nothing is watched until enable_overwrite_guard() is called, as every stage does. For any number of
/// threads.
namespace flightwatt {

void enable_overwrite_guard();

/// Called for every file that is read (read_file does it). Throws UsageError if a result is to go there.
void register_input(const std::filesystem::path& path);

/// A file that the command is going to write: known early, it is refused before anything is written. `option` is
/// what the user named it with ("--output"); empty if by none. Throws UsageError where the file has been read, or is
/// another result's too.
void register_output(const std::filesystem::path& path, const std::string& option = {});

/// Throws UsageError if the file has been read, or was written by this command before.
void check_overwrite(const std::filesystem::path& path);

/// After a file was written.
void mark_written(const std::filesystem::path& path);

/// While it lives, what this thread reads is its program's own record of an earlier run, which is no input, and what it
/// writes may be written again, by whoever made sure that nothing else goes there.
class OverwriteExemption {
  public:
    OverwriteExemption();
    ~OverwriteExemption();
    OverwriteExemption(const OverwriteExemption&) = delete;
    OverwriteExemption& operator=(const OverwriteExemption&) = delete;
};

}  // namespace flightwatt
