// Who may include whom: the arrows of the house, read off the include lines.

#include "test_paths.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

const std::map<std::string, std::set<std::string>> allowed{
    {"base", {}},
    {"telemetry", {"base"}},
    {"flight", {"base", "telemetry"}},
    {"mechanical", {"base", "flight"}},
    {"compute", {"base"}},
    {"battery", {"base", "flight"}},
    {"mission", {"base", "mechanical", "compute", "battery"}},
    {"report", {"base", "flight", "mechanical", "compute", "battery", "mission"}},
    {"batch", {"base", "telemetry", "flight", "mechanical"}},
    {"cli", {"base"}},
};

TEST(IncludeArrows, PointOnlyWhereTheHouseAllows) {
    const std::regex include_line("^\\s*#include \"([^\"/]+)/");
    std::size_t seen = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_dir() / "src")) {
        if (!entry.is_regular_file()) continue;
        const auto room = entry.path().parent_path().filename().string();
        ASSERT_TRUE(allowed.contains(room)) << "a room that the house does not have: " << entry.path();
        std::ifstream file(entry.path());
        std::string line;
        for (std::size_t number = 1; std::getline(file, line); ++number) {
            std::smatch match;
            if (!std::regex_search(line, match, include_line)) continue;
            ++seen;
            const auto target = match[1].str();
            EXPECT_TRUE(target == room || allowed.at(room).contains(target))
                << entry.path().string() << ":" << number << ": " << room << " may not include " << target;
        }
    }
    EXPECT_GT(seen, 50u) << "the include lines were not found";
}

}  // namespace
}  // namespace flightwatt
