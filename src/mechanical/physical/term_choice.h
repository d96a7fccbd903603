#pragma once

#include "mechanical/physical/power_regression.h"
#include "mechanical/physical_fit.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

struct TermSelection {
    std::vector<PowerTerm> terms;  ///< in the order of all_power_terms; empty where none is determined
    std::vector<TermTrial> trials;
    std::size_t folds = 0;
    bool phases_decided = false;  ///< not the bins
};

/// Which terms predict what was held back (see fit_physical_model). `flights` have bins; `regression` is theirs.
TermSelection select_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression);

/// Whether physics lets these coefficients be, in the order of `terms`.
bool are_physical(const std::vector<PowerTerm>& terms, const ColumnVector& coefficients);

/// The columns of terms.
std::vector<int> columns_of(const std::vector<PowerTerm>& terms);

}  // namespace flightwatt::mechanical
