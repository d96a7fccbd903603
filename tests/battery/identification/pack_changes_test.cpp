#include "battery/identification/pack_changes.h"

#include "battery/identification/aligned_fit.h"
#include "helpers/synthetic_discharge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Which flight was flown on the pack of which.
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
        const std::vector<AlignedRecord> known{{&earlier_, 0.0, 0.0, 0.0, 0.0}, {&later_, 0.9, 0.0, 0.0, 0.0}};
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
    const std::vector<AlignedRecord> known{{&earlier_, 0.0, 0.0, 0.0, 0.0}, {&between, 0.0, 0.0, 0.0, 0.0}};
    const auto found = find_pack_link(later_, known, fit_);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->earlier, 1U);
    EXPECT_EQ(found->charge_ah, 0.7);
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two flights in one log, with a minute of telemetry on the ground between: of two packs, or of one.
struct TwoFlights {
    bool new_pack = true;
    bool counter_begins_anew = true;
    bool counts = true;
};

test::SampleColumns two_flights(const TwoFlights& how) {
    auto columns = test::discharge_columns(test::known_pack(), {}, 11);
    test::SyntheticDischarge second;
    if (!how.new_pack) second.initial_charge_ah = columns.charge_ah.back();
    const auto more = test::discharge_columns(test::known_pack(), second, 12);
    const double later_s = columns.time_s.back() + 60.0;
    const double counted_ah = how.counter_begins_anew ? 0.0 : columns.charge_ah.back();
    for (std::size_t i = 0; i < more.time_s.size(); ++i) {
        columns.time_s.push_back(later_s + more.time_s[i]);
        columns.voltage_v.push_back(more.voltage_v[i]);
        columns.current_a.push_back(more.current_a[i]);
        columns.power_w.push_back(more.power_w[i]);
        columns.charge_ah.push_back(counted_ah + more.charge_ah[i]);
    }
    if (!how.counts) columns.charge_ah.clear();
    return columns;
}

DischargeRecords records_of(const TwoFlights& how) {
    return discharge_records(test::series_of(two_flights(how), "two"));
}

TEST(PackChanges, AreToldByVoltageWithAndWithoutACounter) {
    for (const auto& how : {TwoFlights{true, true, true}, {true, false, true}, {true, true, false}}) {
        const auto [records, notes] = records_of(how);
        ASSERT_EQ(records.size(), 2U);
        EXPECT_EQ(records[1].flight, "two#2");
        EXPECT_THAT(notes, ElementsAre(HasSubstr("the pack was changed at 14")));
        for (const auto& record : records) {
            EXPECT_EQ(record.charge_ah.front(), 0.0);
            EXPECT_NEAR(record.resting_voltage_v, open_circuit_voltage_v(test::known_pack(), 100.0), 0.02);
        }
        // One discharge of both had made of the two packs one that holds twice as much.
        EXPECT_NEAR(records[1].charge_ah.back(), records[0].charge_ah.back(), 0.2 * records[0].charge_ah.back());
    }
}

TEST(PackChanges, AreNoneWhereTheSamePackFliesAgain) {
    for (const bool anew : {true, false}) {
        const auto [records, notes] = records_of({false, anew, true});
        ASSERT_EQ(records.size(), 1U);
        const auto once_ah = test::discharge_columns(test::known_pack(), {}, 11).charge_ah.back();
        EXPECT_NEAR(records[0].charge_ah.back(), 2.0 * once_ah, 0.2 * once_ah);
        if (anew)
            EXPECT_THAT(notes, ElementsAre(HasSubstr("the charge counter is reset")));
        else
            EXPECT_THAT(notes, IsEmpty());
    }
}

TEST(PackChanges, CountOnWhereTheCounterBeginsAnewInFlight) {
    auto columns = test::discharge_columns(test::known_pack(), {}, 11);
    const double drawn_ah = columns.charge_ah.back();
    const auto middle = columns.time_s.size() / 2;
    const double at_middle_ah = columns.charge_ah[middle];
    for (auto i = middle; i < columns.time_s.size(); ++i) columns.charge_ah[i] -= at_middle_ah;
    const auto [records, notes] = discharge_records(test::series_of(columns, "reset"));
    ASSERT_EQ(records.size(), 1U);
    EXPECT_NEAR(records[0].charge_ah.back(), drawn_ah, 0.002);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("with the same pack")));
}

TEST(PackChanges, AreNotSeenInWhatAPackRecovers) {
    for (std::uint64_t seed = 1; seed < 8; ++seed) {
        EXPECT_THAT(discharge_records(test::synthetic_discharge(test::known_pack(), {}, seed)).notes, IsEmpty());
    }
}

}  // namespace
}  // namespace flightwatt::battery
