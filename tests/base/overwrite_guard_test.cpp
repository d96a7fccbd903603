#include "base/overwrite_guard.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/test_paths.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt {
namespace {

/// Whether the body ends as it should, in a process of its own: watching has no end.
bool holds_when_watched(const std::function<bool()>& body) {
    const auto child = ::fork();
    if (child == 0) {
        enable_overwrite_guard();
        std::_Exit(body() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool refused(const std::function<void()>& body) {
    try {
        body();
    } catch (const UsageError&) {
        return true;
    }
    return false;
}

class OverwriteGuard : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::filesystem::path input = folder / "input";

    void SetUp() override {
        write_file_atomically(input, "only copy");
        std::filesystem::create_symlink("input", folder / "symlink");
        std::filesystem::create_hard_link(input, folder / "hardlink");
        write_file_atomically(folder / "other", "x");
    }
};

TEST_F(OverwriteGuard, LetsNoResultReplaceWhatWasReadByWhateverName) {
    for (const auto* name :
         {"input", "symlink", "hardlink", "../OverwriteGuard.LetsNoResultReplaceWhatWasReadByWhateverName/input"}) {
        EXPECT_TRUE(holds_when_watched([&] {
            read_file(folder / "symlink");
            write_file_atomically(folder / "other", "y");
            return refused([&] { write_file_atomically(folder / name, "y"); });
        })) << name;
    }
    EXPECT_EQ(read_file(input), "only copy");
}

TEST_F(OverwriteGuard, KnowsThousandsOfInputs) {
    constexpr int count = 1100;
    const auto file = [&](int number) { return folder / ("log" + std::to_string(number)); };
    for (int i = 0; i < count; ++i) write_file_atomically(file(i), "x");
    EXPECT_TRUE(holds_when_watched([&] {
        for (int i = 0; i < count; ++i) read_file(file(i));
        for (const int number : {0, 999, 1000, count - 1})
            if (!refused([&] { write_file_atomically(file(number), "y"); })) return false;
        return !refused([&] { write_file_atomically(folder / "other", "y"); });
    }));
}

TEST_F(OverwriteGuard, RefusesToReadWhatAResultIsToReplace) {
    EXPECT_TRUE(holds_when_watched([&] {
        register_output(folder / "hardlink", "--output");
        return refused([&] { read_file(input); });
    }));
    EXPECT_TRUE(holds_when_watched([&] {
        read_file(input);
        return refused([&] { register_output(folder / "symlink", "--output"); });
    }));
}

TEST_F(OverwriteGuard, RefusesTwoResultsInOneFile) {
    EXPECT_TRUE(holds_when_watched([&] {
        register_output(folder / "new");
        return refused([&] { register_output(folder / "." / "new"); });
    }));
    EXPECT_TRUE(holds_when_watched([&] {
        register_output(input);
        return refused([&] { register_output(folder / "hardlink"); });
    }));
    EXPECT_TRUE(holds_when_watched([&] {
        write_file_atomically(folder / "new", "x");
        return refused([&] { write_file_atomically(folder / "new", "y"); });
    }));
    EXPECT_TRUE(holds_when_watched([&] {
        register_output("/dev/null");
        register_output("/dev/null");
        return true;
    }));
}

TEST_F(OverwriteGuard, LetsAProgramReplaceItsOwnRecords) {
    EXPECT_TRUE(holds_when_watched([&] {
        const OverwriteExemption own;
        read_file(input);
        write_file_atomically(input, "x");
        write_file_atomically(input, "y");
        return read_file(input) == "y";
    }));
}

TEST_F(OverwriteGuard, IsNotWatchedUnlessAsked) {
    register_output(input);
    write_file_atomically(input, read_file(input));
    write_file_atomically(input, read_file(input));
    EXPECT_EQ(read_file(input), "only copy");
}

}  // namespace
}  // namespace flightwatt
