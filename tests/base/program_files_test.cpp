// Where the files that come with the programs are found.

#include "base/program_files.h"

#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

constexpr auto variable = "FLIGHTWATT_TEST_FILES";

TEST(ProgramFiles, AreWhereTheVariableSays) {
    const auto folder = test::scratch_dir();
    ::setenv(variable, folder.c_str(), 1);
    EXPECT_EQ(program_files("web", variable, "the files"), folder);
    ::unsetenv(variable);
}

TEST(ProgramFiles, StandInShareBesideTheFolderOfTheProgram) {
    // This test lies in tests/ of the build, whose share/ is that of the programs in bin/.
    EXPECT_EQ(program_folder().filename(), "tests");
    const auto folder = program_files("docs", variable, "the pages");
    EXPECT_TRUE(std::filesystem::equivalent(folder, test::source_dir() / "docs"));
}

TEST(ProgramFiles, AreMissedWithTheirNameAndTheWayOut) {
    EXPECT_THAT(test::rejected([] { program_files("absent", variable, "the pages"); }),
                testing::AllOf(testing::HasSubstr("share/flightwatt/absent"),
                               testing::HasSubstr("the pages are not there"), testing::HasSubstr(variable)));
}

}  // namespace
}  // namespace flightwatt
