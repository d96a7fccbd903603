#include "batch/write_guard.h"

#include "base/error.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace flightwatt::batch {
FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ < 0) {
        throw OutputError(fmt::format("cannot open the folder {}: {}", folder.string(), std::strerror(errno)));
    }
    if (::flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(folder_);
    throw OutputError(
        fmt::format("another run is writing into {}; wait for it, or choose another folder", folder.string()));
}

RemoveIfEmpty::~RemoveIfEmpty() {
    std::error_code ignored;
    std::filesystem::remove(folder, ignored);
}

FolderLock::~FolderLock() { ::close(folder_); }

}  // namespace flightwatt::batch
