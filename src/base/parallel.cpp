#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace flightwatt {

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t most_threads) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // guards what follows
    std::size_t failed = count;
    std::exception_ptr failure;
    const auto work_on = [&] {
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
        const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
        const std::size_t threads = std::min(most_threads > 0 ? most_threads : cores, count);
        std::vector<std::jthread> workers;
        try {
            for (std::size_t k = 1; k < threads; ++k) workers.emplace_back(work_on);
        } catch (const std::system_error&) {
            // No more threads than these: they will do.
        }
        work_on();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace flightwatt
