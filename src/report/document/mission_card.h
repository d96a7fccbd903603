#pragma once

#include "report/document/simulated_mission.h"

#include <string>
#include <vector>

namespace flightwatt::report {

/// The texts of a mission on the page.
struct MissionCard {
    Outcome outcome = Outcome::keeps;
    std::string words;                    ///< the outcome: "below reserve"
    std::string lead;                     ///< "Lands with 16.2 % of its charge"
    std::string runs;                     ///< its software: "detection 10 fps, encryption 240 key bits, all the time"
    std::string landing;                  ///< charge at landing: "16.2 %"
    std::string aim;                      ///< "keeps the reserve of 20 %"
    std::string probability;              ///< probability of keeping the reserve: "12 %"; "unknown" without uncertainty
    std::string reach_name;               ///< "Longest cruise at 95 %"
    std::string reach;                    ///< "19 min 22 s"
    std::string planned;                  ///< planned cruise: "22 min"; empty for a path
    std::string help;                     ///< a change that keeps the reserve, or what is spare; may be empty
    std::string better = {};              ///< another mission that keeps the reserve; may be empty
    std::vector<std::string> notes = {};  ///< warnings, utility, power model
};
Fields<MissionCard> record_fields(const MissionCard*);

/// Returns the texts of a mission.
MissionCard mission_card(const SimulatedMission& simulated, const MissionAssessment& answer);

/// Returns the text with a capital first letter.
std::string capitalized(std::string text);

/// Returns a probability as text: "12 %", "under 1 %", "over 99 %".
std::string probability_text(double probability);

}  // namespace flightwatt::report
