#pragma once

#include "answer/pack_answer.h"
#include "answer/pack_ledger.h"

#include <vector>

namespace flightwatt::answer {

/// Gives a pack the resistance at a temperature: by a line through ln R of the flights where two of them are 8 K or more
/// from two others; their own within 8 K of their mean; else by resistance_fall_per_k, with a wider interval. The
/// answer states what it rests on, or why it is unknown: then the battery is as flown. `packs` are those of the flights.
void set_temperature(FoundPack& pack, double temperature_c, const std::vector<Pack>& packs);

}  // namespace flightwatt::answer
