#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt::mission {

/// Calls `work` with every number below `count`, on as many threads as the machine has. An exception of any call is
/// thrown here.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace flightwatt::mission
