#pragma once

#include "mechanical/fit_records.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mechanical {

/// The orders that are tried: from 0, a constant, to this.
inline constexpr int max_tested_order = 6;

/// What is predicted from the rest.
enum class HoldOutScheme { one_flight, blocks_of_time };

/// "leave one flight out", "blocks of time".
std::string_view to_string(HoldOutScheme held_back);

/// How well series of one order predict what they have not seen.
struct OrderError {
    int order = 0;
    std::vector<double> mean_square_w2;       ///< of the power that was held back, fold by fold
    std::optional<double> rms_w;              ///< over the folds; absent if one cannot be fitted
    std::string reason;                       ///< why it is absent
    std::optional<double> excess_mse_w2;      ///< mean square error more than the best order's, over folds,
    std::optional<double> standard_error_w2;  ///< and the standard error of that
};

struct OrderSelection {
    int order = 0;  ///< the lowest that is within a standard error of the best
    int best = 0;   ///< that with the least error
    HoldOutScheme held_back = HoldOutScheme::one_flight;
    std::size_t folds = 0;
    std::vector<OrderError> errors;  ///< of orders 0 to max_tested_order
};

/// Chooses a phase's order by cross-validation. Several flights: each is held back in turn and its samples are
/// predicted by the weighted mean curve of the others. One flight: the phase is cut in up to 20 blocks of consecutive
/// samples, since neighbours in time know each other's noise, and every fifth block is held back in turn. Chosen is the
/// lowest order whose mean square error is within one standard error (of the difference, fold by fold) of the least.
/// options.order is not read. Throws NoResultError if no order can be fitted.
OrderSelection select_order(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options,
                            Weighting weighting);

}  // namespace flightwatt::mechanical
