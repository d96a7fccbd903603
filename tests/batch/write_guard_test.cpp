#include "base/error.h"
#include "batch/batch_files.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

TEST(FolderLock, KeepsASecondRunOut) {
    const auto folder = test::scratch_dir();
    std::optional<FolderLock> first(folder);
    try {
        const FolderLock second(folder);
        ADD_FAILURE() << "two at once";
    } catch (const OutputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "another run is writing into " + folder.string() + "; wait for it, or choose another folder");
    }
    first.reset();
    EXPECT_NO_THROW(FolderLock{folder});
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(FolderLock, HoldsOneFolderOnly) {
    const auto folder = test::scratch_dir();
    std::filesystem::create_directories(folder / "a");
    std::filesystem::create_directories(folder / "b");
    const FolderLock first(folder / "a");
    EXPECT_NO_THROW(FolderLock{folder / "b"});
}

TEST(FolderLock, FailsWhereThereIsNoFolder) { EXPECT_THROW(FolderLock{test::scratch_dir() / "missing"}, OutputError); }

}  // namespace
}  // namespace flightwatt::batch
