#pragma once

#include <filesystem>
#include <string>

/// Protection of a folder of results against other runs and signals.
namespace flightwatt::batch {

/// Locks a folder against other runs of batch or profile (flock; ignored by file systems without locks). Throws
/// OutputError if another run holds it, or the folder cannot be opened.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int folder_ = -1;
};

/// Removes a folder at the end if it is empty.
struct RemoveIfEmpty {
    std::filesystem::path folder;
    ~RemoveIfEmpty();
};

/// SIGINT, SIGTERM and SIGHUP then end `program` at once with a note on the standard error and exit code 128 + signal.
/// Signals that are ignored (nohup) stay ignored.
void end_at_signals(const std::string& program);

}  // namespace flightwatt::batch
