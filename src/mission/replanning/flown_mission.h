#pragma once

#include "mechanical/validation.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Pieces of constant power with the measured energy, of 1 s or more, at least from sample to sample. Negative energy
/// counts as 0.
path::PiecewisePower measured_power_profile(const mechanical::PhasePower& measured);

/// The mission as known before a flight: with another mechanical model, its durations where the mission states none,
/// and without a path.
MissionSetup nominal_mission(const MissionSetup& stated, const mechanical::MechanicalModel& model);

/// The mission with the power and durations of a flight, which must have every phase that is flown.
MissionSetup measured_mission(const MissionSetup& known, const mechanical::MeasuredFlight& flight);

}  // namespace flightwatt::mission
