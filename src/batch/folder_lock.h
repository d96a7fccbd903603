#pragma once

#include <filesystem>

namespace flightwatt::batch {

/// Keeps other runs of batch or profile out of a folder while it lives: two at once would remove each other's
/// results. Leaves nothing behind, not even when the program is killed. Throws OutputError where another one
/// holds it, or the folder cannot be opened. File systems without locks are taken as they are.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int folder_ = -1;
};

}  // namespace flightwatt::batch
