#pragma once

#include "battery/identification/circuit_fit.h"

#include <span>
#include <vector>

namespace flightwatt::battery {

/// How many equal segments the curve may have, 1 to 12 and at least twenty samples each, in the order in which they are
/// to be tried. First come the fewest that predict what is left out, where others went as deep, as well as the best do,
/// but for one standard error of the difference (Hastie, Tibshirani and Friedman 2009, section 7.10). Left out is each
/// record in turn; of a single one, each twentieth of its time. Initial charges and time constant are those of `fit`,
/// and resting samples are not asked: all else is linear. A part's own level is free, as its initial charge is a
/// parameter.
std::vector<int> rank_segment_counts(std::span<const AlignedRecord> records, const CircuitFit& fit);

}  // namespace flightwatt::battery
