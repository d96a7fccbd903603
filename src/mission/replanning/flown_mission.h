#pragma once

#include "mechanical/validation.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Pieces of constant power with the energy that was measured in each: from sample to sample, or over as many as make a
/// second. What was measured below 0, which no motor gives back, counts as 0.
path::PiecewisePower measured_power_profile(const mechanical::PhasePower& measured);

/// What is known of a mission before a flight: the mission with another mechanical model. Conditions and path are
/// dropped. Phases whose duration the mission does not state take as long as the model's.
MissionSetup nominal_mission(const MissionSetup& stated, const mechanical::MechanicalModel& model);

/// The mission as a flight was: with its power and its durations. The flight must have every phase that is flown.
MissionSetup measured_mission(const MissionSetup& known, const mechanical::MeasuredFlight& flight);

}  // namespace flightwatt::mission
