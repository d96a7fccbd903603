#pragma once

#include "compute/compute_model.h"
#include "mission/schedule.h"
#include "path/area.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::mission {

/// A mission file with another schedule.
struct PlannedMissionText {
    std::string text;
    bool lost_comments = false;  ///< true: the keys are sorted and have no comments
};

/// Returns the mission file `text` (of `path`) with `schedule` instead of its [plan], [policy] and [[schedule]], and with
/// the lines of `survey` instead of those of its [path], if they are chosen; the
/// rest is kept as written, with comments, if the notation permits. Lines end with \n. `compute` is the mission's.
/// Names of files are relative to `folder`, in which the result is written.
PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder,
                                        const std::optional<path::SurveyLayout>& survey = std::nullopt);

}  // namespace flightwatt::mission
