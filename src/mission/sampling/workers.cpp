#include "mission/sampling/workers.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace flightwatt::mission {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next = 0;
    const auto work_on = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::future<void>> workers;
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    for (std::size_t k = 0; k < std::min(threads, count); ++k)
        workers.push_back(std::async(std::launch::async, work_on));
    for (auto& worker : workers) worker.get();
}

}  // namespace flightwatt::mission
