#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <sched.h>

namespace flightwatt {
namespace {

/// Those that the process may use: of a machine's cores a container, or taskset, may leave it one.
std::size_t count_cores() {
#if defined(__linux__)
    cpu_set_t usable;
    if (::sched_getaffinity(0, sizeof usable, &usable) == 0) return std::max(1, CPU_COUNT(&usable));
#endif
    return std::max(1U, std::thread::hardware_concurrency());
}

std::atomic<std::size_t> thread_limit = 0;

/// The cores to use. Counted once: the system is asked.
std::size_t cores() {
    static const std::size_t count = count_cores();
    const std::size_t limit = thread_limit;
    return limit > 0 ? limit : count;
}

/// Whether this thread works for a loop already: one within it would only make more threads than there are cores.
thread_local bool is_at_work = false;

struct AtWork {
    bool before = std::exchange(is_at_work, true);
    ~AtWork() { is_at_work = before; }
};

}  // namespace

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t max_threads) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // of the variables below
    std::size_t failed = count;
    std::exception_ptr failure;
    const auto work_on = [&](bool is_shared) {
        std::optional<AtWork> at_work;
        if (is_shared) at_work.emplace();
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                // All lower numbers were begun before this one, and are done before this function returns.
                if (i < failed) failure = std::current_exception();
                failed = std::min(failed, i);
                next = count;
            }
        }
    };
    {
        const std::size_t most = is_at_work ? 1 : max_threads > 0 ? max_threads : cores();
        const std::size_t threads = std::min(most, count);
        const bool is_shared = threads > 1 || most == 1;
        std::vector<std::jthread> workers;
        try {
            for (std::size_t k = 1; k < threads; ++k) workers.emplace_back(work_on, is_shared);
        } catch (const std::system_error&) {
            // No more threads than these: they will do.
        }
        work_on(is_shared);
    }
    if (failure) std::rethrow_exception(failure);
}

void limit_threads(std::size_t max_threads) { thread_limit = max_threads; }

}  // namespace flightwatt
