#pragma once

#include "report/batch_content.h"
#include "report/html.h"
#include "report/sections/page_summary.h"

#include <optional>
#include <span>

namespace flightwatt::report {

/// The first screen: headline, a card for each mission (one is shown), their table, and the aircraft.
/// `flights` may be empty.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights);

/// Warnings of the fits, and missing contents; std::nullopt without any.
std::optional<Section> notes_section(const PageSummary& answers);

/// The missions' states of charge in one drawing.
Section curves_section(std::span<const SimulatedMission> missions);

}  // namespace flightwatt::report
