#pragma once

#include "base/text_table.h"
#include "battery/identification.h"
#include "battery/identified_battery.h"
#include "cli/stage.h"

#include <string>
#include <vector>

/// Output of `flightwatt battery`.
namespace flightwatt::cli {

/// "capacity 4.2 Ah (chart), 3.6 to 5.1 Ah in 95 % if ...".
std::string describe(const battery::Capacity& capacity);

/// "using the given capacity of 3.2 Ah; the flights indicate 5.4 Ah (2.45 to 11.5 Ah in 95 %)".
std::string describe_given_capacity(const battery::Battery& pack);

/// Warning of an implausible number of cells, or empty.
std::string cells_warning(const battery::BatteryIdentification& identified);

/// Why a flight is assigned to the pack of another one, or empty.
std::string describe_link(const battery::IdentifiedFlight& flight);

/// "series resistance over 6 flights: +0.40 mohm per flight, ...".
std::string describe(const battery::ResistanceTrend& trend);

/// Capacity, voltage and resistances of a battery file with their 95 % intervals.
TextTable pack_table(const battery::Battery& pack);

/// One row a flight; `left_out` is empty or as long as the identified flights.
TextTable flights_table(const battery::BatteryIdentification& identified,
                        const std::vector<battery::LeaveOneOutCheck>& left_out);

/// Limits of the measured open-circuit curve, a sentence each for below and above.
std::vector<std::string> curve_limits(const battery::BatteryIdentification& identified);

/// The comment at the head of a battery file: flights, capacity and fit.
std::string provenance(const battery::BatteryIdentification& identified);

/// JSON of the stage.
struct BatteryOutput {
    const battery::BatteryIdentification* identified = nullptr;
    const std::vector<battery::LeaveOneOutCheck>* left_out = nullptr;
    std::optional<std::size_t> folds = std::nullopt;  ///< none of a single flight
};
Fields<BatteryOutput> record_fields(const BatteryOutput*);

}  // namespace flightwatt::cli
