#pragma once

#include "base/text_table.h"
#include "battery/identification.h"
#include "mission/mission.h"
#include "report/batch_content.h"
#include "report/html.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A flight that the identification does not use.
struct ExcludedFlight {
    std::string flight;
    std::string reason;
};

/// The battery that the flights were flown on, as identified from them.
struct ReportBattery {
    std::vector<battery::DischargeRecord> records;  ///< of the flights that it rests on
    std::vector<ExcludedFlight> excluded;
    std::vector<std::string> notes;  ///< packs that were changed within a log, counters that began anew
    std::size_t usable = 0;          ///< flights that could be used; more than records where their number is limited
    std::optional<battery::BatteryIdentification> identified;
    std::vector<battery::LeaveOneOutCheck> leave_one_out;  ///< one a record, or empty
    std::string no_result_reason;                          ///< why it was not identified
};

/// Identifies the battery from the flights that have measured current and voltage: from `most` of them, spread evenly,
/// where there are more (the work grows with their square). If the missions fly on one pack of these flights, with its
/// capacity and its cells. Throws UsageError as identify_battery, and for another capacity than that pack's.
ReportBattery identify_for_report(std::span<const ReportFlight> flights, const battery::IdentificationOptions& options,
                                  std::size_t most, std::span<const mission::MissionVariant> missions = {});

/// Parameters with intervals, the flights that they rest on, and those that were excluded: the section's tables.
std::vector<CaptionedTable> battery_tables(const ReportBattery& battery);

/// Measured against modelled voltage, the open-circuit curve, parameters with intervals and how well each
/// flight is predicted by the others; or why there is no such battery.
Section battery_section(const ReportBattery& battery, const SectionScope& of = {});

}  // namespace flightwatt::report
