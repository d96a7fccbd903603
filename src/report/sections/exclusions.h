#pragma once

#include "base/text_table.h"

#include <span>
#include <string>

namespace flightwatt::report {

/// A flight, or a part of it, that is not used.
struct Exclusion {
    std::string flight;
    std::string from;  ///< "from the model"
    std::string reason;
};

/// Returns a table with a row for each reason, with its flights.
TextTable exclusions_table(std::span<const Exclusion> exclusions);

}  // namespace flightwatt::report
