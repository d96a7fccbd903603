#include "compute/profile_tables.h"

#include "base/atomic_file.h"
#include "compute/compute_model.h"
#include "compute/profile_reader.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// 5 and 7 W at 1 and 2; the idle computer takes 2 W.
ProfileOutcome outcome() {
    ProfileOutcome made;
    made.sampler = "a meter";
    made.idle = PowerEstimate{2.0, 0.4, 10.0, 20.0, 100, 1};
    ComponentEstimate component;
    component.name = "load";
    component.parameters = {"n"};
    component.nodes = {{{1.0}, {5.0, 0.3, 4.0, 20.0, 40, 2}}, {{2.0}, {7.0, unknown, 4.0, 28.0, 40, 2}}};
    made.components = {component};
    return made;
}

ProfileSpecification specification(bool above_idle) {
    ProfileSpecification made;
    made.above_idle = above_idle;
    return made;
}

TEST(ReportedPower, AboveIdleHoldsTheErrorOfBoth) {
    const auto power = reported_power({5.0, 0.3}, PowerEstimate{2.0, 0.4}, true);
    EXPECT_DOUBLE_EQ(power.power_w, 3.0);
    EXPECT_DOUBLE_EQ(power.standard_error_w, 0.5);
    EXPECT_DOUBLE_EQ(reported_power({5.0, 0.3}, PowerEstimate{2.0, 0.4}, false).power_w, 5.0);
    EXPECT_DOUBLE_EQ(reported_power({5.0, 0.3}, std::nullopt, false).standard_error_w, 0.3);
}

TEST(NumberOr, SaysWhatIsUnknown) {
    EXPECT_EQ(number_or(1.23456, 2, "-"), "1.23");
    EXPECT_EQ(number_or(unknown, 2, "-"), "-");
}

TEST(LayerTwo, SaysOfWhatItsPowerConsists) {
    const auto made = outcome();
    const auto above = layer2_csv(made.components[0], made, specification(true));
    EXPECT_THAT(above, HasSubstr("above that of the idle computer, 2 W"));
    EXPECT_THAT(above, HasSubstr("\n1,3.000000,0.500000,5.000000,3.000000,4.000000,12.000000,40,2\n"));
    EXPECT_THAT(above, EndsWith("\n2,5.000000,,7.000000,5.000000,4.000000,20.000000,40,2\n"));
    const auto whole = layer2_csv(made.components[0], made, specification(false));
    EXPECT_THAT(whole, HasSubstr("includes the idle computer, 2 W"));
    EXPECT_THAT(whole, HasSubstr("\n1,5.000000,0.300000,5.000000,3.000000,4.000000,20.000000,40,2\n"));
}

TEST(LayerTwo, IsReadByMissions) {
    const auto folder = test::scratch_dir();
    const auto made = outcome();
    write_profiles(made, specification(true), folder);
    EXPECT_DOUBLE_EQ(power_w(read_power_profile(folder / "load.csv"), {1.25}), 3.5);
    const auto idle = read_power_profile(folder / "idle.csv");
    EXPECT_DOUBLE_EQ(power_w(idle, {}), 2.0);
    EXPECT_DOUBLE_EQ(idle.included_idle_w, 2.0) << "not to be added to a profile that includes it";
}

TEST(WriteProfiles, LeavesNoFileOfAComponentWithoutPower) {
    const auto folder = test::scratch_dir();
    auto made = outcome();
    write_profiles(made, specification(false), folder);
    EXPECT_TRUE(std::filesystem::exists(folder / "load.csv"));
    made.components[0].nodes.clear();
    write_profiles(made, specification(false), folder);
    EXPECT_FALSE(std::filesystem::exists(folder / "load.csv")) << "of an earlier call";
}

}  // namespace
}  // namespace flightwatt::compute
