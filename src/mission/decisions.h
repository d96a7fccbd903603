#pragma once

#include <cstddef>

namespace flightwatt::mission {

/// What an adaptive policy decided.
struct Decisions {
    std::size_t made = 0;
    std::size_t without_plan = 0;    ///< where no plan kept the reserve: what drains least was run
    double mechanical_factor = 1.0;  ///< of mechanical power to the model's, as learned at the end
};

}  // namespace flightwatt::mission
