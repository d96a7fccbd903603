#pragma once

#include "battery/identification.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/validation.h"
#include "report/sections/simulated_mission.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Contents of the first section.
struct PageSummary {
    std::vector<SimulatedMission> missions;  ///< the worst first
    std::vector<MissionAssessment> answers;  ///< one a mission
    std::vector<mechanical::ValidatedFlight> validated;
    std::optional<mechanical::MechanicalModel> model;  ///< the batch's
    std::optional<battery::BatteryIdentification> pack;
    std::vector<std::string> warnings;  ///< of the fits
    std::vector<std::string> notes;     ///< missing parts of the page, with reasons
};

}  // namespace flightwatt::report
