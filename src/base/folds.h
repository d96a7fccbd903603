#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt {

/// For cross-validation: which of `count` things are left out together. Each alone, or, of more than `most`, in so many
/// groups of almost equal size in which no two neighbours are. Within a group they rise.
std::vector<std::vector<std::size_t>> folds_of(std::size_t count, std::size_t most);

}  // namespace flightwatt
