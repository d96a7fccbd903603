#include "batch/write_guard.h"

#include "base/error.h"
#include "base/signal_watch.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

std::string note_at_end;  ///< set before any signal is handled

/// _exit(), as exit() would destroy objects that other threads use; all files are complete at any time.
void end_by_signal(int signal) {
    ::pollfd standard_error{STDERR_FILENO, POLLOUT, 0};  // an unread pipe must not block
    if (::poll(&standard_error, 1, 0) > 0) [[maybe_unused]]
        const auto written = ::write(STDERR_FILENO, note_at_end.data(), note_at_end.size());
    constexpr int killed_by_signal = 128;
    ::_exit(killed_by_signal + signal);
}

}  // namespace

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

void end_at_signals(const std::string& program) {
    const auto* behind_a_progress_bar = ::isatty(STDERR_FILENO) != 0 ? "\n" : "";
    note_at_end = fmt::format("{}{}: stopped; run the same command to resume\n", behind_a_progress_bar, program);
    for (const int signal : termination_signals()) std::signal(signal, end_by_signal);
}

}  // namespace flightwatt::batch
