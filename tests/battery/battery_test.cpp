#include "battery/battery.h"

#include "base/error.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

TEST(Battery, CurrentIsTheSmallerRoot) {
    const Battery battery{"", 11.1, 0.05, 3.2};
    for (const double power : {-20.0, 0.0, 0.001, 30.0, 300.0, 616.0}) {
        const double current = internal_current_a(battery, power);
        EXPECT_NEAR(0.05 * current * current - 11.1 * current + power, 0.0, 1e-11 * (1.0 + std::abs(power)));
        EXPECT_LE(current, 11.1 / (2.0 * 0.05));  // the greater root is beyond
        EXPECT_EQ(std::signbit(current), std::signbit(power));
    }
}

TEST(Battery, WithoutResistanceCurrentIsPowerByVoltage) {
    const Battery ideal{"", 4.0, 0.0, 1.0};
    EXPECT_EQ(internal_current_a(ideal, 10.0), 2.5);
    EXPECT_EQ(internal_current_a(ideal, -10.0), -2.5);
    EXPECT_EQ(internal_current_a(ideal, 1e9), 2.5e8);
    EXPECT_TRUE(std::isinf(power_limit_w(ideal)));
}

TEST(Battery, IsContinuousInResistance) {
    // To first order the current is P/U (1 + R P/U^2): the textbook formula loses all digits here.
    for (const double resistance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-300}) {
        const double current = internal_current_a({"", 4.0, resistance, 1.0}, 10.0);
        EXPECT_NEAR(current, 2.5, 2.5 * resistance * 10.0 / 16.0 * 1.01 + 1e-15);
        EXPECT_GE(current, 2.5);
    }
}

TEST(Battery, CannotDeliverBeyondItsLimit) {
    const Battery battery{"", 10.0, 0.1, 1.0};
    EXPECT_DOUBLE_EQ(power_limit_w(battery), 250.0);
    EXPECT_DOUBLE_EQ(internal_current_a(battery, power_limit_w(battery)), 50.0);
    try {
        internal_current_a(battery, 250.5);
        FAIL() << "a power beyond the limit was delivered";
    } catch (const NoResultError& error) {
        EXPECT_STREQ(error.what(), "the battery cannot deliver 250.5 W: its limit U^2 / (4 R) is 250 W");
    }
}

TEST(BatteryWarnings, TellOfUnitsThatNoPackHas) {
    const Battery sound{"pack", 11.1, 0.05, 3.2};
    EXPECT_TRUE(battery_warnings(sound).empty());
    const auto printed = [&](double Battery::*what, double value) {
        auto battery = sound;
        battery.*what = value;
        const auto warnings = battery_warnings(battery);
        return warnings.size() == 1 ? warnings.front() : "";
    };
    EXPECT_EQ(printed(&Battery::capacity_ah, 0.049),
              "battery: 0.049 Ah is too small for a drone's pack: check that the unit is Ah");
    EXPECT_EQ(printed(&Battery::capacity_ah, 0.051), "");
    EXPECT_EQ(printed(&Battery::voltage_v, 111.0),
              "battery: 111 V when full is more than 14 LiPo cells': check that the unit is V");
    EXPECT_EQ(printed(&Battery::voltage_v, 1.11),
              "battery: 1.11 V when full is less than one cell's: check that the unit is V");
    EXPECT_EQ(printed(&Battery::resistance_ohm, 50.0),
              "battery: it cannot deliver more than 0.616 W: check that resistance_ohm is in ohm");
}

TEST(BatteryWarnings, CompareTheCapacityWithTheFlights) {
    Battery pack{"pack", 11.1, 0.05, 5.0};
    EXPECT_EQ(capacity_warning(pack), "") << "a pack of no flights";
    pack.flight_estimate = std::make_shared<FlightEstimate>(FlightEstimate{2.051, {1.74, 3.47}});
    EXPECT_EQ(
        capacity_warning(pack),
        "the capacity of 5 Ah contradicts the flights, which indicate 2.05 Ah (1.74 to 3.47 Ah in 95 %): check the "
        "pack's label, the scale of the current sensor, and whether the flights are of one pack; without a capacity the "
        "estimate of the flights is used");
    EXPECT_EQ(battery_warnings(pack), std::vector{"battery: " + capacity_warning(pack)});
    for (const double outside_ah : {1.739, 3.471}) {
        pack.capacity_ah = outside_ah;
        ASSERT_TRUE(estimated_by_flights(pack)) << outside_ah;
        EXPECT_EQ(estimated_by_flights(pack)->capacity_ah, 2.051);
    }
    for (const double inside_ah : {1.74, 2.0, 3.47}) {
        pack.capacity_ah = inside_ah;
        EXPECT_FALSE(estimated_by_flights(pack)) << inside_ah;
        EXPECT_TRUE(battery_warnings(pack).empty()) << inside_ah;
    }
}

TEST(Monitors, OfFlightsHaveKnownPartsWhereFlightsAgree) {
    using Monitors = std::vector<flight::MonitorShare>;
    EXPECT_EQ(common_monitors({{}, {}}), Monitors{});
    EXPECT_EQ(common_monitors({{{1, 1.0}}, {}}), Monitors{});
    EXPECT_EQ(common_monitors({{{2, 1.0}}}), (Monitors{{2, 1.0}}));
    EXPECT_EQ(common_monitors({{{1, 0.52}, {2, 0.48}}, {{1, 0.56}, {2, 0.44}}}), (Monitors{{1, 0.54}, {2, 0.46}}));
    const Monitors unknown{{1, 0.0}, {2, 0.0}};
    EXPECT_EQ(common_monitors({{{1, 0.5}, {2, 0.5}}, {{1, 0.56}, {2, 0.44}}}), unknown) << "6 points apart";
    EXPECT_EQ(common_monitors({{{1, 0.5}, {2, 0.5}}, {{1, 1.0}}}), unknown);
    EXPECT_EQ(common_monitors({{{1, 0.5}, {2, 0.5}}, {}}), unknown);
    EXPECT_EQ(common_monitors({{{1, 0.0}, {2, 0.0}}}), unknown);
}

}  // namespace
}  // namespace flightwatt::battery
