#include "report/figures/mission_figures.h"

#include "compute/profile_reader.h"
#include "helpers/rejected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

Figure figure_of(const std::string& csv) {
    compute::ComputeModel compute;
    compute.components.push_back(
        {"detection", compute::read_power_profile(test::write_text(test::scratch_dir() / "p.csv", csv))});
    return profile_figure(compute, "profile-1");
}

TEST(ProfileFigure, ShowsIntervals) {
    const auto figure = figure_of("fps,power_w,standard_error_w\n1,2,0.5\n2,4,0.25\n3,6,0.5\n");
    const auto& panel = figure.spec["concat"][0]["layer"][0];  // next to the panel's name
    EXPECT_EQ(panel["layer"].size(), 3U) << "line, intervals, points";
    const auto rows = panel["data"]["values"].get<std::string>();
    EXPECT_THAT(rows, HasSubstr("2,4,0.25,3.51001,4.48999,"));
    EXPECT_THAT(figure.caption, HasSubstr("95 % intervals"));
}

TEST(ProfileFigure, DrawsNoIntervalWhereNoneIsKnown) {
    const auto figure = figure_of("fps,power_w\n1,2\n2,4\n");
    EXPECT_EQ(figure.spec["concat"][0]["layer"][0]["layer"].size(), 2U);
    EXPECT_THAT(figure.caption, HasSubstr("Points were profiled"));
}

}  // namespace
}  // namespace flightwatt::report
