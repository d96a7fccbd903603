#pragma once

#include "compute/compute_model.h"
#include "mission/schedule.h"
#include "path/area.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mission {

/// A mission file with another schedule.
struct PlannedMissionText {
    std::string text;
    bool lost_comments = false;  ///< true: the keys are sorted and have no comments
};

/// The flight with one pack of a mission with [packs], whose path is a plan of its own.
struct PlannedPack {
    std::size_t pack = 1;                         ///< its number
    std::string name;                             ///< of the mission
    std::string plan_file;                        ///< as the mission names it
    std::vector<std::string> blocks;              ///< of a flight plan of Paparazzi
    std::optional<double> airspeed_m_per_s = {};  ///< if the plan's file has none: with blocks also instead of a stated
};

/// Returns the mission file `text` (of `path`) with `schedule` instead of its [plan], [policy] and [[schedule]], and with
/// the lines of `survey` instead of those of its [path], if they are chosen; the rest is kept as written, with comments,
/// if the notation permits. Lines end with \n. `compute` is the mission's. Names of files are relative to `folder`, in
/// which the result is written. With `pack` it is the mission of that flight.
PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder,
                                        const std::optional<path::SurveyLayout>& survey = std::nullopt,
                                        const std::optional<PlannedPack>& pack = std::nullopt);

}  // namespace flightwatt::mission
