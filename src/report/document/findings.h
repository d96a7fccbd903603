#pragma once

#include "battery/identified_battery.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/validation.h"
#include "report/document/simulated_mission.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// What several parts of a document are about.
struct Findings {
    std::vector<SimulatedMission> missions;              ///< the worst first
    std::vector<MissionAssessment> assessments;          ///< one for each mission
    std::vector<mechanical::ValidatedFlight> validated;  ///< predictions by leave-one-out; may be empty
    std::optional<mechanical::MechanicalModel> model;    ///< model of the batch
    std::optional<battery::BatteryIdentification> pack;
    std::vector<std::string> warnings;  ///< warnings of the fits
    std::vector<std::string> notes;     ///< missing parts of the document, with reasons
};

}  // namespace flightwatt::report
