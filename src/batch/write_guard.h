#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

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

/// Lets files be written whole before the program ends: those who write are inside, whoever ends the program
/// closes it first.
class WriteGate {
  public:
    /// Being inside, as long as it lives.
    class WriterGuard {
      public:
        explicit WriterGuard(WriteGate& gate);
        ~WriterGuard();
        WriterGuard(const WriterGuard&) = delete;
        WriterGuard& operator=(const WriterGuard&) = delete;

      private:
        WriteGate& gate_;
    };

    /// Lets nobody in any more (who comes waits for the end of the program) and waits until all have left,
    /// but no longer than `timeout`; false if some are still inside then.
    bool close(std::chrono::milliseconds timeout);

  private:
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable changed_;
    std::size_t active_writers_ = 0;
    bool closed_ = false;
};

/// While it lives, SIGINT, SIGTERM and SIGHUP end the program within a second, whatever its threads are computing: the
/// gate is closed, `on_signal` is called with the signal, in a thread of its own, and the exit code is 128 + the
/// signal, as shells expect. A second signal ends it at once. Signals that the program was started to ignore (nohup)
/// stay ignored. To be made before other threads are, which inherit that the signals are blocked.
class TerminationHandler {
  public:
    TerminationHandler(WriteGate& gate, std::function<void(int signal)> on_signal);
    ~TerminationHandler();
    TerminationHandler(const TerminationHandler&) = delete;
    TerminationHandler& operator=(const TerminationHandler&) = delete;

  private:
    std::vector<int> signals_;
    std::stop_source over_;
    std::optional<std::jthread> thread_;
};

}  // namespace flightwatt::batch
