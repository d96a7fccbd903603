#include "answer/pack_answer.h"

#include "base/error.h"
#include "helpers/aged_flights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::HasSubstr;

FlightFacts logged(std::optional<double> capacity_ah, std::optional<double> voltage_v = 15.0) {
    return {.flight = "a", .cruise_s = 60.0, .stated_capacity_ah = capacity_ah, .mean_voltage_v = voltage_v};
}

TEST(ChooseCapacity, TakesTheGivenOneBeforeThatOfTheLogs) {
    EXPECT_EQ(choose_capacity(3.0, {logged(5.0)}).value_ah, 3.0);
    EXPECT_FALSE(choose_capacity(3.0, {logged(5.0)}).is_logged);
    EXPECT_EQ(choose_capacity({}, {logged(5.0), logged({})}).value_ah, 5.0);
    EXPECT_TRUE(choose_capacity({}, {logged(5.0)}).is_logged);
}

TEST(ChooseCapacity, HasNoneWhereLogsDiffer) {
    const auto several = choose_capacity({}, {logged(30.0), logged(5.2), logged(30.0)});
    EXPECT_FALSE(several.value_ah);
    EXPECT_THAT(several.warning, HasSubstr("state capacities of 5.2 and 30 Ah: none is used; --capacity"));
    EXPECT_FALSE(choose_capacity({}, {logged({})}).value_ah);
}

TEST(ChooseCapacity, DoesNotTakeThatOfAParameterWhichNobodySet) {
    const auto unset = choose_capacity({}, {logged(3.3), logged(3.3)});
    EXPECT_FALSE(unset.value_ah);
    EXPECT_THAT(unset.warning, HasSubstr("3.3 Ah, the default of ArduPilot's BATT_CAPACITY"));
    EXPECT_EQ(choose_capacity(3.3, {logged(3.3)}).value_ah, 3.3);
}

TEST(IdentifiedRecords, OfManyHaveBothEndsTheFullestAndTheDeepest) {
    std::vector<battery::DischargeRecord> records(200);
    for (auto& record : records) record.charge_ah = {0.0, 1.0};
    EXPECT_EQ(identified_records(std::span(records).first(60)).size(), 60U);
    records[76].charge_ah.back() = 2.0;
    records[131].resting_voltage_v = 12.6;
    const auto chosen = identified_records(records);
    EXPECT_LE(chosen.size(), 62U);
    EXPECT_TRUE(std::ranges::is_sorted(chosen));
    for (const std::size_t number : {0U, 76U, 131U, 199U}) EXPECT_TRUE(std::ranges::binary_search(chosen, number));
}

TEST(FindPack, HasTheMeanVoltageWhereNothingElseIsKnown) {
    const auto pack = find_pack({}, "no current", {5.0, "as given"}, {logged({}, 15.0), logged({}, 16.0)});
    EXPECT_NEAR(pack.battery.voltage_v, 15.5, 1e-12);
    EXPECT_EQ(pack.battery.capacity_ah, 5.0);
    EXPECT_FALSE(pack.answer.resistance_ohm.value);
    EXPECT_EQ(pack.answer.resistance_ohm.unknown, "no current");
    ASSERT_EQ(pack.warnings.size(), 1U);
    EXPECT_THAT(pack.warnings.front(), HasSubstr("assumed to have 15.5 V"));
}

TEST(FindPack, KeepsTheMonitorsOfPacksOfConstantVoltage) {
    auto flown = logged({});
    flown.monitors = {{1, 0.5}, {2, 0.5}};
    EXPECT_EQ(find_pack({}, "no current", {5.0, "as given"}, {flown, flown}).battery.monitors, flown.monitors);
}

/// A pack of 2.4 Ah, less 8 % at the end, whose resistance rises by 30 %.
std::vector<battery::DischargeRecord> ageing_pack() {
    return test::aged_flights({.ohm_a_day = 0.0002, .part_a_day = 0.0007, .flights = 8}, 3).records;
}

TEST(FindPack, KeepsTheLogsCapacityOfAPackThatAges) {
    const auto pack = find_pack(ageing_pack(), "", {2.4, "by the logs", true}, {logged(2.4)});
    EXPECT_EQ(pack.answer.capacity_ah.value, 2.4);
    EXPECT_EQ(pack.battery.capacity_ah, 2.4);
    EXPECT_FALSE(estimated_by_flights(pack.battery)) << "or missions warn of it again";
}

TEST(FindPack, OfAPackThatAgesHasNoCapacityThatNoneOfItsFlightsHas) {
    const auto pack = find_pack(ageing_pack(), "", {}, {logged({})});
    if (pack.answer.capacity_ah.value)
        EXPECT_NEAR(*pack.answer.capacity_ah.value, 2.3, 0.8);
    else
        EXPECT_THAT(pack.answer.capacity_ah.unknown, HasSubstr("--capacity AH"));
}

TEST(FindPack, LeavesALogsCapacityWithWhichNoFlightAgrees) {
    const auto pack = find_pack(ageing_pack(), "", {20.0, "by the logs", true}, {logged(20.0)});
    EXPECT_LT(pack.answer.capacity_ah.value.value_or(0.0), 10.0);
    ASSERT_FALSE(pack.warnings.empty());
    EXPECT_THAT(pack.warnings.back(), HasSubstr("the logs' capacity of 20 Ah is not used"));
}

TEST(FindPack, SaysWhatIsMissing) {
    const auto reason = [](const CapacityChoice& capacity, const FlightFacts& facts) -> std::string {
        try {
            find_pack({}, "no current", capacity, {facts});
        } catch (const NoResultError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(reason({}, logged({})), HasSubstr("--capacity AH"));
    EXPECT_THAT(reason({5.0, "as given"}, logged({}, {})), HasSubstr("no log has the pack's voltage"));
}

}  // namespace
}  // namespace flightwatt::answer
