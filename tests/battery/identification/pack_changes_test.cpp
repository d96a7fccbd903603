#include "battery/identification/pack_changes.h"

#include "battery/discharge_record.h"
#include "helpers/synthetic_discharge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two flights in one log, with a minute of telemetry on the ground between: of two packs, or of one.
struct TwoFlights {
    bool new_pack = true;
    bool counter_begins_anew = true;
    bool counts = true;
    double missing_ah = 0.0;  ///< of the second, where the first pack flies again or a new one begins
};

test::SampleColumns two_flights(const TwoFlights& how) {
    auto columns = test::discharge_columns(test::known_pack(), {}, 11);
    test::SyntheticDischarge second;
    second.initial_charge_ah = how.missing_ah + (how.new_pack ? 0.0 : columns.charge_ah.back());
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
    return discharge_records(select_tracks(test::series_of(two_flights(how), "two")));
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

/// The first pack's charge was taken for that of an emptier one.
TEST(PackChanges, AreToldByAVoltageThatFalls) {
    const auto first_ah = records_of({}).records[0].charge_ah.back();
    const auto [records, notes] = records_of({true, true, true, first_ah + 0.6});
    ASSERT_EQ(records.size(), 2U);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("the voltage falls from")));
    EXPECT_NEAR(records[1].resting_voltage_v, open_circuit_voltage_v(test::known_pack(), 100.0), 2.0);
    EXPECT_LT(records[1].resting_voltage_v, records[0].resting_voltage_v - 0.2);
}

TEST(PackChanges, AreNoneInAGlide) {
    auto columns = two_flights({});
    for (const double time_s : columns.time_s) columns.altitude_m.push_back(5000.0 - time_s);
    const auto [records, notes] = discharge_records(select_tracks(test::series_of(columns, "two")));
    EXPECT_EQ(records.size(), 1U);
    EXPECT_THAT(notes, testing::Each(testing::Not(HasSubstr("the pack was changed"))));
}

TEST(PackChanges, AreNoneWhereTheSamePackFliesAgain) {
    for (const bool again : {true, false}) {
        const auto [records, notes] = records_of({false, again, true});
        ASSERT_EQ(records.size(), 1U);
        const auto once_ah = test::discharge_columns(test::known_pack(), {}, 11).charge_ah.back();
        EXPECT_NEAR(records[0].charge_ah.back(), 2.0 * once_ah, 0.2 * once_ah);
        if (again)
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
    const auto [records, notes] = discharge_records(select_tracks(test::series_of(columns, "reset")));
    ASSERT_EQ(records.size(), 1U);
    EXPECT_NEAR(records[0].charge_ah.back(), drawn_ah, 0.002);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("with the same pack")));
}

TEST(PackChanges, AreNotSeenInWhatAPackRecovers) {
    for (std::uint64_t seed = 1; seed < 8; ++seed) {
        EXPECT_THAT(discharge_records(select_tracks(test::synthetic_discharge(test::known_pack(), {}, seed))).notes,
                    IsEmpty());
    }
}

}  // namespace
}  // namespace flightwatt::battery
