#include "base/atomic_file.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(AtomicFile, ReplacesTheContentAndLeavesNothingElse) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "a.txt", "old");
    write_file_atomically(folder / "a.txt", "new");
    EXPECT_EQ(read_file(folder / "a.txt"), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(AtomicFile, RefusesWhatCannotBeWrittenAndKeepsWhatWasThere) {
    const auto folder = test::scratch_dir();
    EXPECT_THROW(write_file_atomically(folder / "missing" / "a.txt", "x"), OutputError);
    EXPECT_THROW(write_file_atomically(folder, "x"), OutputError);
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    EXPECT_THROW(write_file_atomically("/dev/full", "x"), OutputError);
    EXPECT_THROW(write_file_atomically(folder / std::string(300, 'x'), "x"), OutputError);
    EXPECT_THROW(make_directories(folder / "a.txt" / "b" / std::string(300, 'x')), OutputError);
}

}  // namespace
}  // namespace flightwatt
