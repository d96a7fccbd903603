#pragma once

#include <filesystem>

#include <gtest/gtest.h>

namespace flightwatt::test {

std::filesystem::path source_dir();
std::filesystem::path binary_dir();  ///< of this build

/// Returns the folder of a synthetic log for each difficulty of segmentation, which the build makes (tests/CMakeLists.txt):
/// hazard_01_NAME.data with its phases, hazard_01_NAME.truth.csv.
std::filesystem::path hazards_dir();

/// Where the programs are: bin/ of this build, or the folder that FLIGHTWATT_PROGRAMS names, where something stands
/// between (scripts/build_arm64).
std::filesystem::path programs_dir();

/// The folder of real logs and published figures next to the project; empty where it is absent.
std::filesystem::path shared_dir();

/// A folder of its own for the running test, empty at its start.
std::filesystem::path scratch_dir();

}  // namespace flightwatt::test

/// Skips, visibly, a test of real data where that is absent.
#define FLIGHTWATT_NEEDS_SHARED() \
    if (flightwatt::test::shared_dir().empty()) GTEST_SKIP() << "../shared is not here"
