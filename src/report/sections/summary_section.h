#pragma once

#include "report/batch_content.h"
#include "report/html.h"
#include "report/sections/page_summary.h"

#include <optional>
#include <span>
#include <string_view>

namespace flightwatt::report {

/// Returns the first screen: headline, a card for each mission (one is shown), their table, and the aircraft. `flights`
/// may be empty. `heading` is the element of the headline.
Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights,
                        std::string_view heading = "h1");

/// Returns the section of warnings of the fits and missing contents; std::nullopt without any.
std::optional<Section> notes_section(const PageSummary& answers);

/// Returns the section with the states of charge of all missions in one drawing.
Section curves_section(std::span<const SimulatedMission> missions);

}  // namespace flightwatt::report
