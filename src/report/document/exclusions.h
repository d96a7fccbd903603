#pragma once

#include "record/record.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A flight, or a part of it, that is not used.
struct Exclusion {
    std::string flight;
    std::string from;  ///< "for the model"
    std::string reason;
};

/// Flights that are not used for one reason.
struct ExclusionGroup {
    std::vector<std::string> flights;  ///< at most ten, then "12 more"
    std::size_t number = 0;
    std::string from;
    std::string reason;
};
Fields<ExclusionGroup> record_fields(const ExclusionGroup*);

/// Returns the flights of each reason.
std::vector<ExclusionGroup> group_exclusions(std::span<const Exclusion> exclusions);

}  // namespace flightwatt::report
