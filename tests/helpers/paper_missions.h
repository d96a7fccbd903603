#pragma once

#include "helpers/test_paths.h"
#include "mission/mission_file.h"

#include <filesystem>
#include <string>

namespace flightwatt::test {

/// A mission file of missions/paper/.
inline std::filesystem::path paper_mission_path(const std::string& name) {
    return source_dir() / "missions" / "paper" / (name + ".toml");
}

/// One with a schedule.
inline mission::Mission paper_mission(const std::string& name) {
    return std::get<mission::Mission>(mission::read_mission(paper_mission_path(name)));
}

/// One that is yet to be planned.
inline mission::PlanningProblem paper_problem(const std::string& name) {
    return std::get<mission::PlanningProblem>(mission::read_mission(paper_mission_path(name), {true, std::nullopt}));
}

}  // namespace flightwatt::test
