#include "report/report_flight.h"

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(FittedPart, FollowsExclusionsAndThePowerRecord) {
    ReportFlight flight;
    EXPECT_EQ(fitted_part(flight), "all");
    flight.exclusions = {"cruise is excluded: the log ends inside of it"};
    EXPECT_EQ(fitted_part(flight), "in part");
    flight.unusable_power = "its power does not change at all";
    EXPECT_EQ(fitted_part(flight), "no");
}

}  // namespace
}  // namespace flightwatt::report
