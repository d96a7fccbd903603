#pragma once

#include "report/batch_content.h"
#include "report/html.h"
#include "report/outline.h"
#include "report/sections/battery_section.h"

#include <optional>
#include <vector>

namespace flightwatt::report {

/// Returns the section with a map for each flight with positions, on one scale: phases, charge every 5 minutes, and
/// outlines below them. `battery` may be null. std::nullopt without positions.
std::optional<Section> tracks_section(const BatchContent& batch, const ReportBattery* battery,
                                      const std::vector<Outline>& outlines = {});

}  // namespace flightwatt::report
