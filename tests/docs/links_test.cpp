#include "helpers/document.h"
#include "helpers/test_paths.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

bool is_on_the_web(const std::string& target) { return target.find("://") != std::string::npos; }

TEST(Documents, HaveNoDeadLinks) {
    std::size_t checked = 0;
    for (const auto& path : all_documents()) {
        const auto document = read_document(path);
        for (const auto& link : document.links) {
            if (is_on_the_web(link.target)) continue;
            ++checked;
            const auto hash = link.target.find('#');
            const auto file = link.target.substr(0, hash);
            const auto target = file.empty() ? path : path.parent_path() / file;
            const auto where = path.string() + ":" + std::to_string(link.line) + ": " + link.target;
            ASSERT_TRUE(std::filesystem::exists(target)) << where << " is not there";
            if (hash == std::string::npos) continue;
            const auto anchors = read_document(target).anchors;
            EXPECT_NE(std::find(anchors.begin(), anchors.end(), link.target.substr(hash + 1)), anchors.end())
                << where << ": there is no such heading";
        }
    }
    EXPECT_GT(checked, 20U);
}

TEST(Documents, AreReadableInATerminal) {
    for (const auto& path : all_documents()) {
        for (const auto& line : read_document(path).long_lines)
            ADD_FAILURE() << path.string() << ": more than 120 characters: " << line;
    }
}

TEST(Readme, FitsOnAFewScreens) { EXPECT_LE(std::filesystem::file_size(source_dir() / "README.md"), 8192U); }

TEST(Documents, PathsWithCapitalsStandForAnyWord) {
    EXPECT_TRUE(path_matches("components.NAME.qos", "components.detection.qos"));
    EXPECT_TRUE(path_matches("sorties[].phases[].phase", "sorties.phases.phase"));
    EXPECT_FALSE(path_matches("components.NAME", "components.detection.qos"));
    EXPECT_FALSE(path_matches("components.NAME.qos", "components.detection.command"));
}

}  // namespace
}  // namespace flightwatt::test
