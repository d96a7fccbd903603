#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt {

/// Calls `work` with every number below `count`, on `max_threads` at most, or on as many as it has cores to use (0).
/// Where calls throw, it throws the exception of the lowest number, on any number of threads; further numbers may then
/// be left out. Within a loop that several threads share, or that may have but one, another one has the thread that
/// calls it alone.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work, std::size_t max_threads = 0);

/// Calls make(i, place) with every number below `count`, as for_each_in_parallel does, and take(i, place) once it is
/// made and all lower numbers are taken: one at a time, while others are made. `place`, below threads_for(count,
/// max_threads), is held by one number until that is taken: what is made may lie there. Where calls throw, it throws
/// the exception of the lowest number; none is taken behind that.
void for_each_in_order(std::size_t count, const std::function<void(std::size_t, std::size_t)>& make,
                       const std::function<void(std::size_t, std::size_t)>& take, std::size_t max_threads = 0);

/// The most threads that a loop of `count` has: `max_threads`, or as many as it has cores to use (0).
std::size_t threads_for(std::size_t count, std::size_t max_threads = 0);

}  // namespace flightwatt
