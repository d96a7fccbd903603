#pragma once

#include "base/text_table.h"
#include "battery/identification.h"
#include "battery/identified_battery.h"
#include "cli/stage.h"

#include <string>
#include <vector>

/// What `flightwatt battery` says of an identified battery.
namespace flightwatt::cli {

/// "capacity 4.2 Ah (chart), 3.6 to 5.1 Ah in 95 % if ...".
std::string describe(const battery::Capacity& capacity);

/// "using the given capacity of 3.2 Ah; the flights indicate 5.4 Ah (2.45 to 11.5 Ah in 95 %)".
std::string describe_given_capacity(const battery::Battery& pack);

/// What is doubtful of the number of cells; empty if nothing is.
std::string cells_warning(const battery::BatteryIdentification& identified);

/// Why a flight is taken for one on the pack of another; empty if it is not.
std::string describe_link(const battery::IdentifiedFlight& flight);

/// How the resistance goes on over the flights: "series resistance over 6 flights in time order: +0.4 mohm a flight
/// ...".
std::string describe(const battery::ResistanceTrend& trend);

/// Capacity, voltage and resistances of a battery file with their 95 % intervals.
TextTable pack_table(const battery::Battery& pack);

/// One row a flight; `left_out` is empty or as long as the identified flights.
TextTable flights_table(const battery::BatteryIdentification& identified,
                        const std::vector<battery::LeaveOneOutCheck>& left_out);

/// How far flights show the open-circuit voltage, a sentence each for below and above.
std::vector<std::string> curve_limits(const battery::BatteryIdentification& identified);

/// The comment at the head of a battery file: flights, capacity and fit that the numbers rest on.
std::string provenance(const battery::BatteryIdentification& identified);

/// The stage's JSON: units are in the keys, null stands for what is not known.
Json to_json(const battery::BatteryIdentification& identified, const std::vector<battery::LeaveOneOutCheck>& left_out);

}  // namespace flightwatt::cli
