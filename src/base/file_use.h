#pragma once

#include <filesystem>
#include <string>

/// Which files this command reads and which it writes, so that no result replaces what it was made from, by whatever
/// name or link. Nothing is watched until watch_file_use() is called, as every stage does. For any number of threads.
namespace flightwatt {

void watch_file_use();

/// Called for every file that is read (read_file does it). Throws UsageError if a result is to go there.
void note_input(const std::filesystem::path& path);

/// A file that the command is going to write: known early, it is refused before anything is written. `option` is
/// what the user named it with ("--output"); empty if by none. Throws UsageError where the file has been read, or is
/// another result's too.
void declare_output(const std::filesystem::path& path, const std::string& option = {});

/// Throws UsageError if the file has been read, or was written by this command before.
void refuse_to_lose(const std::filesystem::path& path);

/// After a file was written.
void note_written(const std::filesystem::path& path);

/// While it lives, what this thread reads is its program's own record of an earlier run, which is no input, and what it
/// writes may be written again, by whoever made sure that nothing else goes there.
class OwnFiles {
  public:
    OwnFiles();
    ~OwnFiles();
    OwnFiles(const OwnFiles&) = delete;
    OwnFiles& operator=(const OwnFiles&) = delete;
};

}  // namespace flightwatt
