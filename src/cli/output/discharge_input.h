#pragma once

#include "battery/discharge_record.h"
#include "cli/output/flight_options.h"

#include <cstddef>
#include <optional>
#include <vector>

/// What the flights of a call show of their pack.
namespace flightwatt::cli {

/// Reads the discharges of the call's flights, of one circuit (default: the one with the most energy). Each flight
/// without one is named, with the reason. Throws InputError where none can be used.
std::vector<battery::DischargeRecord> discharge_records(const StageCall& call, FlightArguments flights,
                                                        std::optional<std::size_t> circuit = std::nullopt);

}  // namespace flightwatt::cli
