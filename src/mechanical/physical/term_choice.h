#pragma once

#include "mechanical/physical/power_regression.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// Minimum relative reduction of the cross-validated mean square error to keep a term.
inline constexpr double min_mse_reduction = 0.05;

struct TermSelection {
    std::vector<PowerTerm> terms;  ///< in the order of all_power_terms; empty where none is determined
    std::vector<TermTrial> trials;
    std::size_t folds = 0;
    bool phases_decided = false;  ///< not the bins
};

/// The terms that predict hold-out flights (see fit_physical_model). `flights` have bins; `regression` is theirs.
TermSelection select_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression);

}  // namespace flightwatt::mechanical
