#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt::batch {

/// Calls `work` with every number below `count`, on as many threads as the machine has. Where calls throw, it throws the
/// exception of the lowest number, on any number of threads; further numbers may then be left out.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace flightwatt::batch
