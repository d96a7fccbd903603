#pragma once

#include "battery/discharge.h"
#include "mission/load_segments.h"

namespace flightwatt::mission {

/// The battery after the charge that it loses at once as a demand begins.
battery::Discharge after_drop(battery::Discharge state, const Demand& demand);

/// What a demand leaves in the mission's battery, for flights that are flown by the thousand. Where the drain
/// does not depend on the state of charge and power is never negative, without resistance, it is the closed
/// integral that drain tables hold; elsewhere Runge-Kutta with steps of a second. A battery that has given
/// out, or cannot deliver, stays as it is.
battery::Discharge after_demand(const Mission& mission, const Demand& demand, battery::Discharge state);

}  // namespace flightwatt::mission
