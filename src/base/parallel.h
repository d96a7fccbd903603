#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt {

/// Calls `work` with every number below `count`, on `max_threads` at most, or on as many as it has cores to use (0).
/// Where calls throw, it throws the exception of the lowest number, on any number of threads; further numbers may then
/// be left out. Within a loop that several threads share, or that may have but one, another one has the thread that
/// calls it alone.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t max_threads = 0);

/// From now on a loop with max_threads = 0 has so many threads at most; 0: as many as there are cores.
void limit_threads(std::size_t max_threads);

/// Receives the progress of long work, from any thread.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

}  // namespace flightwatt
