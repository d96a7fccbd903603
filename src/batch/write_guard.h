#pragma once

#include <filesystem>
#include <string>

/// What keeps a folder of results whole: from other runs, and from the program's own end.
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

/// A folder that is removed at the end if nothing is left in it.
struct RemoveIfEmpty {
    std::filesystem::path folder;
    ~RemoveIfEmpty();
};

/// From now on SIGINT, SIGTERM and SIGHUP end `program` at once, whatever its threads are computing: with a note on the
/// standard error, and the exit code 128 + the signal, as shells expect. For programs whose files are whole at any
/// moment. Signals that the program was started to ignore (nohup) stay ignored.
void end_at_signals(const std::string& program);

}  // namespace flightwatt::batch
