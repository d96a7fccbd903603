#pragma once

#include "live/prediction.h"
#include "mission/mission.h"

#include <string>

namespace flightwatt::live {

/// What a mission lets predict: its model, its path or else the time of its cruise, its battery (its capacity as
/// uncertain as in the mission's drawn flights) and limits. Where its
/// model does not allow a prediction, `cannot_predict` says why. The setup has a mechanical model; `file` names the
/// mission in errors. Throws InputError for a path that cannot be flown.
PredictionBasis mission_basis(const mission::MissionSetup& setup, const std::string& file);

/// The same without the battery. Throws InputError where the model does not allow a prediction.
PredictionBasis path_basis(const mission::MissionSetup& setup, const std::string& file);

/// `remaining_s` more of the cruise from any moment on, and the model's usual landing. Throws as require_spread.
PredictionBasis model_basis(mechanical::MechanicalModel model, const std::string& file, double remaining_s);

}  // namespace flightwatt::live
