#include "base/temporary_folder.h"

#include "base/atomic_file.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(TemporaryFolder, IsRemovedWithWhatIsInIt) {
    std::filesystem::path path;
    {
        const TemporaryFolder folder;
        path = folder.path();
        write_file_atomically(path / "file", "text");
        EXPECT_TRUE(std::filesystem::is_directory(path));
        EXPECT_NE(TemporaryFolder().path(), path);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace flightwatt
