#pragma once

#include "report/figure.h"
#include "report/figures/published_figures.h"
#include "report/figures/qos_map.h"
#include "report/simulated_mission.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The map as the paper's Fig. 4: a cell is the mean of its four corners, and the configurations that the
/// missions run are marked. `published` are digitised cells of the same axes, drawn as points of their own
/// colour on the same scale: one that agrees is hardly seen.
Figure qos_map_figure(const QosMap& map, std::span<const SimulatedMission> missions,
                      const std::vector<PublishedCell>& published, const std::string& id);

}  // namespace flightwatt::report
