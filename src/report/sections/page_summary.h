#pragma once

#include "battery/identification.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/validation.h"
#include "report/sections/simulated_mission.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The contents of the first section.
struct PageSummary {
    std::vector<SimulatedMission> missions;              ///< the worst first
    std::vector<MissionAssessment> answers;              ///< one for each mission
    std::vector<mechanical::ValidatedFlight> validated;  ///< predictions by leave-one-out; may be empty
    std::optional<mechanical::MechanicalModel> model;    ///< model of the batch
    std::optional<battery::BatteryIdentification> pack;
    std::vector<std::string> warnings;  ///< warnings of the fits
    std::vector<std::string> notes;     ///< missing parts of the page, with reasons
};

}  // namespace flightwatt::report
