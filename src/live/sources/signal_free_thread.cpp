#include "live/sources/signal_free_thread.h"

#include <csignal>
#include <utility>

namespace flightwatt::live {

std::thread start_without_signals(std::function<void()> work) {
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(work));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

}  // namespace flightwatt::live
