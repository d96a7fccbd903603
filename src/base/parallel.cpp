#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
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

/// Counted once: the system is asked.
std::size_t cores() {
    static const std::size_t count = count_cores();
    return count;
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
    std::mutex mutex;  // guards what follows
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

void for_each_in_order(std::size_t count, const std::function<void(std::size_t, std::size_t)>& make,
                       const std::function<void(std::size_t, std::size_t)>& take, std::size_t max_threads) {
    const auto threads = threads_for(count, max_threads);
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // guards what follows, and is held by the one that takes
    std::condition_variable taken;
    std::size_t turn = 0;
    bool has_failed = false;
    const auto work_at = [&](std::size_t place) {
        for (std::size_t i = next++; i < count; i = next++) {
            std::exception_ptr failure;
            try {
                make(i, place);
            } catch (...) {
                failure = std::current_exception();  // it counts when its turn comes: the lowest one does
            }
            std::unique_lock lock(mutex);
            taken.wait(lock, [&] { return turn == i || has_failed; });
            if (has_failed) return;
            has_failed = true;
            if (failure) {
                taken.notify_all();
                std::rethrow_exception(failure);
            }
            try {
                take(i, place);
            } catch (...) {
                taken.notify_all();
                throw;
            }
            has_failed = false;
            ++turn;
            taken.notify_all();
        }
    };
    for_each_in_parallel(threads, work_at, threads);
}

std::size_t threads_for(std::size_t count, std::size_t max_threads) {
    return std::min(count, max_threads > 0 ? max_threads : cores());
}

}  // namespace flightwatt
