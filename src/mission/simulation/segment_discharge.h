#pragma once

#include "battery/discharge.h"
#include "mission/simulation/load_segments.h"

namespace flightwatt::mission {

/// The battery after the charge that it loses at once as a segment starts.
battery::Discharge after_drop(battery::Discharge state, const LoadSegment& segment);

/// The state of a battery after a segment, for flights that are flown by the thousand. Where the depletion
/// does not depend on the state of charge and power is never negative, without resistance, it is the closed
/// integral that depletion tables hold; elsewhere Runge-Kutta with steps of a second. A battery that has
/// ended, or cannot deliver, stays as it is.
battery::Discharge after_segment(const battery::Battery& battery, double cutoff_voltage_v,
                                 const LoadSegment& segment, battery::Discharge state);

}  // namespace flightwatt::mission
