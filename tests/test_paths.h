#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::test {

inline std::filesystem::path source_dir() { return FLIGHTWATT_SOURCE_DIR; }

/// The folder of real logs and published figures beside the project; empty where it is absent.
inline std::filesystem::path shared_dir() {
    const auto folder = source_dir().parent_path() / "shared";
    return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

/// A folder of its own for the running test, empty at its start.
inline std::filesystem::path scratch_dir() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    for (auto& c : name) {
        if (c == '/') c = '_';
    }
    auto folder = std::filesystem::path(FLIGHTWATT_BINARY_DIR) / "scratch" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace flightwatt::test

/// Skips, visibly, a test of real data where that is absent.
#define FLIGHTWATT_NEEDS_SHARED() \
    if (flightwatt::test::shared_dir().empty()) GTEST_SKIP() << "../shared is not here"
