#pragma once

#include <filesystem>

/// Protection of a folder of results against other runs.
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

}  // namespace flightwatt::batch
