#pragma once

#include "live/prediction.h"
#include "mission/mission.h"

#include <string>

namespace flightwatt::live {

/// What a mission lets predict: its model, its path or else the time of its cruise, its battery (its capacity as
/// uncertain as in the mission's drawn flights) and limits. Where its model does not allow a prediction,
/// `no_prediction_reason` says why. The setup has a mechanical model; `file` names the mission in errors. Throws
/// InputError for a path that cannot be flown.
PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// The same without the battery. Throws InputError where the model does not allow a prediction.
PredictionInput path_input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// `remaining_s` more of the cruise from any moment on, and the model's usual landing. Throws as require_spread.
PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s);

}  // namespace flightwatt::live
