#include "flight/airspeed.h"

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(Airspeed, MeanCubeCountsGusts) {
    const Track airspeed{.time_s = {0.0, 1.0, 2.0, 3.0, 99.0}, .value = {10.0, 10.0, 14.0, 14.0, 50.0}};
    EXPECT_DOUBLE_EQ(mean_cubed_airspeed_m3_per_s3(airspeed, 0.0, 4.0).value(), (1000.0 + 2744.0) / 2.0);
}

TEST(Airspeed, IsUnknownWhereItWasHardlyMeasured) {
    EXPECT_FALSE(mean_cubed_airspeed_m3_per_s3({}, 0.0, 10.0).has_value());
    const Track airspeed{.time_s = {0.0, 1.0}, .value = {10.0, 10.0}};
    EXPECT_TRUE(mean_cubed_airspeed_m3_per_s3(airspeed, 0.0, 11.0).has_value());
    EXPECT_FALSE(mean_cubed_airspeed_m3_per_s3(airspeed, 0.0, 13.0).has_value());
}

}  // namespace
}  // namespace flightwatt::flight
