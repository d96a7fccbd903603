#include "compute/profile_interpolation.h"

#include "compute/profile_reader.h"
#include "helpers/test_paths.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

TEST(GridInterpolation, LeavesOutBetweenNeighbours) {
    const auto profile = make_power_profile("p", {"x"}, {{{0}, 1.0, {}}, {{1}, 5.0, {}}, {{4}, 9.0, {}}});
    const auto error = leave_one_out(profile);
    EXPECT_EQ(error.nodes, 1U);
    EXPECT_TRUE(std::isnan(error.error_w[0]));
    EXPECT_DOUBLE_EQ(error.error_w[1], 3.0 - 5.0);
    EXPECT_DOUBLE_EQ(error.mean_absolute_percent, 40.0);
}

PowerProfile real_grid() {
    ProfileNaming naming;
    naming.columns = {"first", "second", "power_w"};
    return read_power_profile(test::shared_dir() / "powprofiler" / "tx2_two_component_power.csv", naming);
}

/// The eight recordings as their config4.cfg joins them; it names them without the prefix they are kept with.
PowerProfile real_recordings() {
    const auto folder = test::scratch_dir();
    for (const auto& entry : std::filesystem::directory_iterator(test::shared_dir() / "powprofiler")) {
        const auto name = entry.path().filename().string();
        if (name.starts_with("tracking_")) std::filesystem::copy(entry.path(), folder / name.substr(9));
    }
    ProfileNaming naming;
    naming.parameters = {"yolo_fps", "nfold_fps"};
    return read_power_profile(folder / "config4.cfg", naming);
}

TEST(GridInterpolation, OfTheRealProfiles) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& profile : {real_grid(), real_recordings()}) {
        const auto error = leave_one_out(profile);
        EXPECT_EQ(error.nodes, profile.power_w.size() == 25 ? 21U : 4U);
        EXPECT_LT(error.mean_absolute_percent, 4.0);
    }
}

TEST(LeaveOneOut, SummarizesTheNodesThatWereFound) {
    const auto summary = summarize_errors({1.0, std::nan(""), -3.0}, {10.0, 5.0, 20.0});
    EXPECT_EQ(summary.nodes, 2U);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_w, 2.0);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_percent, 12.5);
    EXPECT_DOUBLE_EQ(summary.rms_w, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(summary.largest_w, 3.0);
}

TEST(LeaveOneOut, OfNoNodeIsZero) { EXPECT_EQ(summarize_errors({std::nan("")}, {1.0}).rms_w, 0.0); }

}  // namespace
}  // namespace flightwatt::compute
