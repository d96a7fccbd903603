#pragma once

#include "mission/mission.h"

#include <vector>

namespace flightwatt::mission {

/// Maximum number of ways to cover an area that a plan chooses between.
inline constexpr double max_survey_layouts = 2000.0;

/// Returns every way to cover the area before the flight.
std::vector<path::SurveyLayout> all_layouts(const SurveyChoices& choices);

/// Returns every way to continue at a time of the cruise: the lines up to the present one stay, the rest of its block
/// and each later block has one of the levels. Empty where nothing is left to choose: on the way to the first line, and
/// from the last line on. At 0 s nothing is flown yet, and all layouts with the survey's course are returned.
std::vector<path::SurveyLayout> remaining_layouts(const SurveyChoices& choices, const SurveyCoverage& survey,
                                                  double cruise_s);

}  // namespace flightwatt::mission
