#include "cli/output/batch_folder.h"

#include "helpers/test_paths.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

// flightwatt init makes a folder for fits, which a run without logs removed.
TEST(BatchFolder, RemovesWhatItMadeAndStayedEmptyAlone) {
    const auto folder = test::scratch_dir();
    { const BatchFolder made(folder / "new"); }
    EXPECT_FALSE(std::filesystem::exists(folder / "new"));
    std::filesystem::create_directory(folder / "old");
    { const BatchFolder found(folder / "old"); }
    EXPECT_TRUE(std::filesystem::exists(folder / "old"));
}

}  // namespace
}  // namespace flightwatt::cli
