#include "batch/write_guard.h"

#include "base/error.h"
#include "base/signal_watch.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

/// Of the second within which an interrupted program has to end.
constexpr std::chrono::milliseconds patience_with_writers(700);

sigset_t set_of(const std::vector<int>& signals) {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : signals) sigaddset(&set, signal);
    return set;
}

void change_mask(int how, const std::vector<int>& signals) {
    const auto set = set_of(signals);
    ::pthread_sigmask(how, &set, nullptr);
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

WriteGate::WriterGuard::WriterGuard(WriteGate& gate) : gate_(gate) {
    std::unique_lock lock(gate_.mutex_);
    gate_.changed_.wait(lock, [this] { return !gate_.closed_; });
    ++gate_.active_writers_;
}

WriteGate::WriterGuard::~WriterGuard() {
    const std::lock_guard lock(gate_.mutex_);
    --gate_.active_writers_;
    gate_.changed_.notify_all();
}

bool WriteGate::close(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    closed_ = true;
    return changed_.wait_for(lock, timeout, [this] { return active_writers_ == 0; });
}

TerminationHandler::TerminationHandler(WriteGate& gate, std::function<void(int signal)> on_signal)
    : signals_(termination_signals()) {
    if (signals_.empty()) return;
    change_mask(SIG_BLOCK, signals_);
    const auto wait = [this, &gate, on_signal = std::move(on_signal), over = over_.get_token()] {
        const auto set = set_of(signals_);
        int signal = 0;
        if (::sigwait(&set, &signal) != 0 || over.stop_requested()) return;
        change_mask(SIG_UNBLOCK, signals_);  // here, so that a second one ends the program if we are stuck
        gate.close(patience_with_writers);
        on_signal(signal);
        // Not exit(): it would destroy what the other threads are using. All files are whole, and the
        // kernel releases the rest.
        constexpr int killed_by_signal = 128;
        ::_exit(killed_by_signal + signal);
    };
    thread_.emplace(wait);
}

TerminationHandler::~TerminationHandler() {
    if (!thread_) return;
    over_.request_stop();
    ::pthread_kill(thread_->native_handle(), signals_.front());  // wakes it
    thread_->join();
    change_mask(SIG_UNBLOCK, signals_);
}

}  // namespace flightwatt::batch
