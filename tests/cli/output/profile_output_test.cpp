// What is printed of a profile.

#include "cli/output/profile_output.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Two nodes of one component, the second with a single sample, 2 W idle.
compute::ProfileOutcome outcome() {
    compute::ProfileOutcome profiled;
    profiled.sampler = "command meter";
    profiled.idle = compute::PowerEstimate{2.0, 0.1, 10.0, 20.0, 100, 1};
    compute::ComponentEstimate component;
    component.name = "detection";
    component.parameters = {"fps"};
    component.nodes.push_back({{10.0}, {5.0, 0.1, 4.0, 20.0, 40, 2}});
    component.nodes.push_back({{20.0}, {6.0, std::nan(""), 4.0, 24.0, 1, 1}});
    profiled.components.push_back(component);
    return profiled;
}

TEST(ProfileText, ShowsTotalPowerOrThatAboveIdle) {
    const auto measured = outcome();
    const auto total = profile_text({&measured, false});
    EXPECT_THAT(total, HasSubstr("idle power: 2 W"));
    EXPECT_THAT(total, HasSubstr("\ndetection\n"));
    EXPECT_THAT(total, HasSubstr("5.0000"));
    EXPECT_THAT(total, HasSubstr("24.00"));
    const auto above = profile_text({&measured, true});
    EXPECT_THAT(above, HasSubstr("\ndetection, above idle\n"));
    EXPECT_THAT(above, HasSubstr("3.0000"));
}

TEST(ProfileText, FitsTheScreen) {
    const auto measured = outcome();
    Screen narrow;
    narrow.is_terminal = true;
    narrow.columns = 44;
    const auto text = profile_text({&measured, false}, narrow);
    EXPECT_THAT(text, HasSubstr("not shown: "));
    EXPECT_THAT(text, HasSubstr("fps"));
    EXPECT_THAT(text, HasSubstr("6.0000"));
    narrow.wide = true;
    EXPECT_THAT(profile_text({&measured, false}, narrow), Not(HasSubstr("not shown: ")));
}

TEST(ProfileText, SaysThatNothingCouldBeMeasured) {
    auto failed = outcome();
    failed.components.front().nodes.clear();
    EXPECT_THAT(profile_text({&failed, false}), HasSubstr("detection\nno configuration was measured\n"));
}

TEST(ProfileJson, HoldsReportedAndTotalPower) {
    const auto measured = outcome();
    const auto json = record_json(ProfileOutput{&measured, true});
    const auto& node = json["components"][0]["nodes"][0];
    EXPECT_EQ(node["qos"][0], 10.0);
    EXPECT_EQ(node["power_w"], 3.0);
    EXPECT_EQ(node["total_power_w"], 5.0);
    EXPECT_EQ(node["energy_j"], 12.0);
    EXPECT_NEAR(node["standard_error_w"].get<double>(), std::hypot(0.1, 0.1), 1e-12) << "that of idle as well";
    EXPECT_EQ(json["components"][0]["nodes"][1]["energy_j"], 16.0);
}

}  // namespace
}  // namespace flightwatt::cli
