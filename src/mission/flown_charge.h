#pragma once

#include "battery/discharge.h"
#include "mission/demand.h"

namespace flightwatt {

/// The battery after the charge that it loses at once as a demand begins.
Discharge after_drop(Discharge state, const Demand& demand);

/// What a demand leaves in the mission's battery, for flights that are flown by the thousand. Where the drain
/// does not depend on the state of charge and power is never negative, without resistance, it is the closed
/// integral that drain tables hold; elsewhere Runge-Kutta with steps of a second. A battery that has given
/// out, or cannot deliver, stays as it is.
Discharge after_demand(const Mission& mission, const Demand& demand, Discharge state);

}  // namespace flightwatt
