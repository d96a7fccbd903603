#pragma once

#include "base/text_table.h"
#include "battery/identified_battery.h"
#include "cli/stage.h"

#include <string>
#include <vector>

/// Output of `flightwatt battery`.
namespace flightwatt::cli {

/// "capacity 4.2 Ah (chart), 3.6 to 5.1 Ah in 95 % if ...".
std::string describe(const battery::Capacity& capacity);

/// A sentence on an identified battery, without the dot at its end.
struct BatteryRemark {
    std::string text;
    bool is_warning = false;
};

/// What limits the identification: capacity, cells, curve and RC pair.
std::vector<BatteryRemark> battery_remarks(const battery::BatteryIdentification& identified);

/// Capacity, voltage and resistances of a battery file with their 95 % intervals.
TextTable pack_table(const battery::Battery& pack);

/// One row a flight; `left_out` is empty or as long as the identified flights.
TextTable flights_table(const battery::BatteryIdentification& identified,
                        const std::vector<battery::LeaveOneOutCheck>& left_out);

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
