#pragma once

#include "base/text_table.h"
#include "mechanical/validation.h"
#include "report/html.h"

#include <optional>
#include <span>
#include <vector>

namespace flightwatt::report {

/// Power from airspeed and climb, fitted to the flights: figure, constants, and what was tried. std::nullopt where no
/// flight measured its motion, or it does not tell their power.
std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights, const SectionOf& of = {});

/// Its tables; none where there is no such section.
std::vector<CaptionedTable> physical_tables(std::span<const mechanical::MeasuredFlight> flights);

}  // namespace flightwatt::report
