// Which flight was flown on the pack of which.

#include "battery/identification/pack_link.h"

#include "helpers/synthetic_discharge.h"

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

/// A flight that draws 0.9 Ah, and one 20 minutes later that begins there; on a curve that falls by 1 V/Ah.
class Packs : public testing::Test {
  protected:
    Packs() {
        earlier_.flight = "earlier";
        earlier_.time_s = {10.0, 1210.0};
        earlier_.charge_ah = {0.0, 0.9};
        earlier_.resting_voltage_v = 12.4;
        earlier_.start_clock_s = 1e9;
        later_.flight = "later";
        later_.time_s = {5.0, 900.0};
        later_.charge_ah = {0.0, 0.4};
        later_.resting_voltage_v = 11.6;
        later_.start_clock_s = 1e9 + 2400.0;
        fit_.knots_ah = {0.0, 1.5};
        fit_.open_circuit_v = {12.4, 10.9};
        fit_.weights.cells = 3;
        fit_.weights.fullest_rest_v = 12.4;
    }
    std::optional<PackLink> link() const {
        const std::vector<AlignedRecord> known{{&earlier_, 0.0}, {&later_, 0.9}};
        return find_pack_link(later_, known, fit_);
    }
    DischargeRecord earlier_;
    DischargeRecord later_;
    CircuitFit fit_;
};

TEST_F(Packs, GoOnWhereClockAndVoltageAgree) {
    const auto found = link();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->earlier, 0U);
    EXPECT_EQ(found->charge_ah, 0.9);
    EXPECT_EQ(found->pause_s, 1200.0);
    EXPECT_FALSE(found->counter_continues);
}

TEST_F(Packs, DoNotGoOnAfterHoursOrBackwards) {
    later_.start_clock_s = 1e9 + 8.0 * 3600.0;
    EXPECT_FALSE(link());
    later_.start_clock_s = 1e9 + 600.0;  // while the other one flies
    EXPECT_FALSE(link());
    later_.start_clock_s.reset();
    EXPECT_FALSE(link());
}

TEST_F(Packs, TakeTheClockOfTheNamesWhereTheLogsHaveNone) {
    earlier_.start_clock_s.reset();
    earlier_.flight = "20_07_10__06_53_03";
    later_.flight = "20_07_10__07_33_13";
    const auto found = link();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->pause_s, 2410.0 + 5.0 - 1210.0);
    later_.flight = "20_13_10__07_33_13";
    EXPECT_FALSE(link()) << "no month";
}

TEST_F(Packs, AreOthersWhereTheVoltageSaysSo) {
    later_.resting_voltage_v = 12.35;  // charged
    EXPECT_FALSE(link());
    later_.resting_voltage_v = 10.5;  // emptier than it was left
    EXPECT_FALSE(link());
    later_.resting_voltage_v = 11.6;
    later_.is_other_pack = true;
    EXPECT_FALSE(link());
}

TEST_F(Packs, AreToldByTheCounter) {
    earlier_.counter_ah = Interval{0.0, 0.9};
    later_.counter_ah = Interval{0.0, 0.4};
    ASSERT_TRUE(link());
    EXPECT_FALSE(link()->counter_continues) << "it began anew";
    later_.counter_ah = Interval{0.905, 1.305};
    ASSERT_TRUE(link());
    EXPECT_TRUE(link()->counter_continues);
    later_.counter_ah = Interval{0.3, 0.7};
    EXPECT_FALSE(link()) << "something else was counted in between";
}

TEST_F(Packs, AreNotToldApartByWhatHardlyFell) {
    earlier_.charge_ah.back() = 0.02;
    later_.resting_voltage_v = 12.38;
    EXPECT_FALSE(link());
}

TEST_F(Packs, AreThoseOfTheLatestFlightBefore) {
    auto between = earlier_;
    between.flight = "between";
    between.start_clock_s = 1e9 + 1210.0;
    between.time_s = {0.0, 600.0};
    between.resting_voltage_v = 12.4;
    between.charge_ah = {0.0, 0.7};
    const std::vector<AlignedRecord> known{{&earlier_, 0.0}, {&between, 0.0}};
    const auto found = find_pack_link(later_, known, fit_);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->earlier, 1U);
    EXPECT_EQ(found->charge_ah, 0.7);
}

}  // namespace
}  // namespace flightwatt::battery
