#pragma once

#include "record/json_type.h"
#include "report/document/simulated_mission.h"

#include <string>

namespace flightwatt::report {

/// A mission's outcome, and its texts on the page (MissionDocument's card of web/app/src/documents.ts).
struct MissionCard {
    Outcome outcome = Outcome::keeps;
    Json texts;
};

/// Returns the card of a mission; "better" is empty yet.
MissionCard mission_card(const SimulatedMission& simulated, const MissionAssessment& answer);

/// Returns the text with a capital first letter.
std::string capitalized(std::string text);

/// Returns a probability as text: "12 %", "under 1 %", "over 99 %".
std::string probability_text(double probability);

}  // namespace flightwatt::report
