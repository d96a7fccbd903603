#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt::report {

/// Receives the progress of long work, from any thread.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

}  // namespace flightwatt::report
