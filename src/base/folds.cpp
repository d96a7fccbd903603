#include "base/folds.h"

#include <algorithm>

namespace flightwatt {

std::vector<std::vector<std::size_t>> folds_of(std::size_t count, std::size_t most) {
    std::vector<std::vector<std::size_t>> folds(std::min(count, most));
    for (std::size_t i = 0; i < count && !folds.empty(); ++i) folds[i % folds.size()].push_back(i);
    return folds;
}

}  // namespace flightwatt
