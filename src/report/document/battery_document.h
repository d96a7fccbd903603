#pragma once

#include "battery/identification.h"
#include "mission/mission.h"
#include "report/batch_content.h"
#include "report/document/exclusions.h"
#include "report/latex_tables.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The battery that was identified from the flights.
struct ReportBattery {
    std::vector<battery::DischargeRecord> records;  ///< discharge records of the flights used
    std::vector<Exclusion> exclusions;
    std::vector<std::string> notes;  ///< about pack changes within a log and counter resets
    std::size_t usable = 0;          ///< number of usable flights; more than records if their number is limited
    std::optional<battery::BatteryIdentification> identified;
    std::vector<battery::LeaveOneOutCheck> leave_one_out;  ///< one for each record, or empty
    std::string no_result_reason;                          ///< reason why there is no result
};

/// Identifies the battery from the flights with measured current and voltage, at most `max_flights` at equal steps,
/// with the capacity and cells of the missions' first pack that these flights may have. Throws UsageError as
/// identify_battery, and for another capacity than that pack's.
ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t max_flights, std::span<const mission::MissionVariant> missions = {});

/// Returns the battery of the flights, or the reason why none was identified (BatteryDocument of
/// web/app/src/documents.ts), and adds its tables.
Json battery_json(const ReportBattery& battery, LatexTables& tables);

}  // namespace flightwatt::report
