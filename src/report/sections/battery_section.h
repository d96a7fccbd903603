#pragma once

#include "battery/identification.h"
#include "mission/mission.h"
#include "report/batch_content.h"
#include "report/html.h"
#include "report/sections/exclusions.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The battery, as identified from the flights.
struct ReportBattery {
    std::vector<battery::DischargeRecord> records;  ///< of the flights used
    std::vector<Exclusion> exclusions;
    std::vector<std::string> notes;  ///< pack changes within a log, counter resets
    std::size_t usable = 0;          ///< usable flights; more than records where their number is limited
    std::optional<battery::BatteryIdentification> identified;
    std::vector<battery::LeaveOneOutCheck> leave_one_out;  ///< one a record, or empty
    std::string no_result_reason;                          ///< of missing results
};

/// Identifies the battery from the flights with measured current and voltage, `max_flights` at equal steps; with the
/// capacity and cells of the first pack of the missions that is of these flights. Throws UsageError as
/// identify_battery, and for another capacity than that pack's.
ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t max_flights, std::span<const mission::MissionVariant> missions = {});

/// Parameters with intervals, voltages, errors of leave-one-out, open-circuit curve; or the reason for no battery.
Section battery_section(const ReportBattery& battery);

}  // namespace flightwatt::report
