#pragma once

#include "mechanical/flight_bins.h"
#include "mechanical/physical_model.h"
#include "mechanical/speed_to_fly.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// A flight that is not in the fit.
struct SkippedFlight {
    std::string flight;
    std::string reason;
};

struct PhysicalFit {
    PhysicalModel model;
    std::vector<TermTrial> trials;  ///< in the order of all_power_terms
    std::vector<SkippedFlight> skipped;
    bool folds_are_flights = true;  ///< false: blocks of a single flight's time
    bool phases_decided = true;     ///< false: trials have the error of bins, not of whole phases
    std::size_t folds = 0;
    std::optional<SpeedToFly> speeds = {};  ///< in calm air; absent where the flights do not determine drag
};

/// Fits power to the motion of flights of one aircraft (docs/methods.md, Power from airspeed and climb), with terms
/// chosen by cross-validation over flights (ten groups of more than ten), or over fifths of a single flight's time:
///   first       the drag, or a constant where that predicts bins better by min_mse_reduction
///   then        one by one, the term that lowers the error of the mean power of whole phases most, if that is by
///               min_mse_reduction, in more than half of the flights (of two, in one), and bins are predicted no worse; the payload
///               where it predicts bins better
/// Coefficients are physically possible (not negative; a descent returns at most the climb's power), and not more than
/// the phases of each fit. Bins decide for a single flight, and where a flight has bins of one phase only. Throws
/// NoResultError where no flight has bins, or they do not determine a single term.
PhysicalFit fit_physical_model(std::span<const BinnedFlight> flights);

/// The same with these terms alone.
PhysicalModel fit_power_terms(std::span<const BinnedFlight> flights, const std::vector<PowerTerm>& terms);

}  // namespace flightwatt::mechanical
