#pragma once

#include "report/figure.h"
#include "report/figures/published_figures.h"
#include "report/simulated_mission.h"

#include <span>
#include <string>

namespace flightwatt::report {

/// State of charge over time, a line a mission, as the paper's Fig. 3, with the phases of the first mission
/// marked where all have the same; the digitised curves as points beside missions of their names; and below,
/// on the same time axis, a strip a mission with the power of what it runs. `missions` is not empty.
Figure schedule_figure(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                       const std::string& id);

}  // namespace flightwatt::report
