#pragma once

#include "battery/identification/circuit_fit.h"

#include <span>
#include <vector>

namespace flightwatt::battery {

/// How many equal segments the curve may have, 1 to 12 and at least twenty samples each, the best first: by how well the
/// samples of what is left out are predicted, where others went as deep. Left out is each record in turn; of a single
/// one, each twentieth of its time. Initial charges and time constant are those of `fit`, and resting samples are not
/// asked: all else is linear. A part's own level is free, as its initial charge is a parameter.
std::vector<int> segments_by_prediction(std::span<const AlignedRecord> records, const CircuitFit& fit);

}  // namespace flightwatt::battery
