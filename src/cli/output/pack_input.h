#pragma once

#include "answer/pack_names.h"
#include "cli/output/flight_options.h"
#include "cli/output/pack_output.h"

#include <cstddef>
#include <optional>
#include <vector>

/// What the flights of a call show of their packs.
namespace flightwatt::cli {

/// Reads the uses of packs in the call's flights, named as name_packs() does, of one circuit (default: the one with the
/// most energy). Each flight without one is named, with the reason. Throws InputError where none can be used.
std::vector<answer::PackUse> read_pack_uses(const StageCall& call, FlightArguments flights, const PackArguments& packs,
                                            std::optional<std::size_t> circuit = std::nullopt);

/// Returns the discharges of all uses. Warns where they are of several packs.
std::vector<battery::DischargeRecord> records_of(const StageCall& call, const std::vector<answer::PackUse>& uses);

}  // namespace flightwatt::cli
