#pragma once

#include "flight/flight_phases.h"
#include "flight/segmentation/activity.h"
#include "flight/segmentation/flight_grid.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// A height that is held for so long before the landing is worked at, however low [s].
inline constexpr double min_work_hold_s = 90.0;
/// So is one, in the upper half of the flight, that is held for this part of the longest hold before it.
inline constexpr double min_work_hold_fraction = 0.5;

/// The edges of one sortie; absent where the log begins or ends in the air.
struct SortieEdges {
    std::optional<double> lift_off_s;
    std::optional<double> takeoff_end_s;
    std::optional<double> landing_start_s;
    std::optional<double> touchdown_s;
    std::vector<HeldAltitude> held;  ///< see Sortie
};

SortieEdges find_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options);

}  // namespace flightwatt::flight
