#include "flight/select/positions.h"

#include <cstddef>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A flight of 100 s at 10 m/s to the north, a position a second.
FlightData flown_north() {
    FlightData data;
    data.longitude_deg.source = "GPS.Lng";
    for (int second = 0; second <= 100; ++second) {
        for (auto* track : {&data.latitude_deg, &data.longitude_deg}) track->time_s.push_back(second);
        data.latitude_deg.value.push_back(47.0 + 10.0 * second / 111195.0);
        data.longitude_deg.value.push_back(8.0);
    }
    return data;
}

TEST(UnreachablePositions, AreRemovedAndCountedWhereOneIsOnAnotherContinent) {
    auto data = flown_north();
    data.longitude_deg.value[50] = 68.0;
    data.latitude_deg.value[70] += 1000.0 / 111195.0;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.longitude_deg.value.size(), 99U);
    EXPECT_EQ(data.latitude_deg.time_s, data.longitude_deg.time_s);
    EXPECT_THAT(data.longitude_deg.value, testing::Each(8.0));
    EXPECT_THAT(data.longitude_deg.notes,
                ElementsAre("2 of 101 positions (GPS.Lng) are removed: no aircraft flies there in the time between the "
                            "others"));
}

TEST(UnreachablePositions, AreRemovedWhereTheLogBeginsOrEndsWithThem) {
    auto data = flown_north();
    for (const std::size_t i : {0U, 1U, 100U}) data.longitude_deg.value[i] = -42.0;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.latitude_deg.time_s.front(), 2.0);
    EXPECT_EQ(data.latitude_deg.time_s.back(), 99.0);
}

TEST(UnreachablePositions, AreThoseOfMetresToo) {
    auto data = flown_north();
    data.east_m = data.longitude_deg;
    data.north_m = data.latitude_deg;
    data.north_m.value[50] = 9e6;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.east_m.value.size(), 100U);
    EXPECT_EQ(data.longitude_deg.value.size(), 101U);
}

TEST(UnreachablePositions, AreNotWhereAnAircraftFliesInAGapOrAcrossTheMeridianOf180Degrees) {
    auto data = flown_north();
    for (std::size_t i = 50; i <= 100; ++i) {
        data.latitude_deg.time_s[i] += 60.0;
        data.longitude_deg.time_s[i] += 60.0;
        data.latitude_deg.value[i] += 5000.0 / 111195.0;
    }
    for (std::size_t i = 0; i <= 100; ++i) data.longitude_deg.value[i] = i % 2 == 0 ? 179.9999 : -179.9999;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.latitude_deg.value.size(), 101U);
    EXPECT_THAT(data.longitude_deg.notes, IsEmpty());
}

TEST(UnreachablePositions, StayWithANoteWhereTheyAreMoreThanHalf) {
    auto data = flown_north();
    for (std::size_t i = 0; i <= 100; ++i) data.longitude_deg.value[i] += 0.01 * static_cast<double>(i);
    remove_unreachable_positions(data);
    EXPECT_EQ(data.latitude_deg.value.size(), 101U);
    ASSERT_EQ(data.longitude_deg.notes.size(), 1U);
    EXPECT_THAT(data.longitude_deg.notes.front(), HasSubstr("check the unit and the clock"));
}

TEST(PositionsWithoutAFix, AreRemovedEvenWhereAllAre) {
    auto data = flown_north();
    for (std::size_t i = 30; i < 80; ++i) data.longitude_deg.value[i] = data.latitude_deg.value[i] = 0.0;
    auto none = data;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.latitude_deg.value.size(), 51U);
    EXPECT_THAT(data.longitude_deg.notes, ElementsAre(HasSubstr("50 of 101 positions (GPS.Lng) are removed: latitude "
                                                                "and longitude are 0")));
    for (std::size_t i = 0; i <= 100; ++i) none.longitude_deg.value[i] = none.latitude_deg.value[i] = 0.0;
    remove_unreachable_positions(none);
    EXPECT_TRUE(none.latitude_deg.empty());
    EXPECT_TRUE(none.longitude_deg.empty());
}

TEST(PositionsOnTwoClocks, LoseWhatIsBetweenTheOthers) {
    auto data = flown_north();
    for (auto& time_s : data.latitude_deg.time_s) time_s += 0.5;
    data.latitude_deg.value[50] = -47.0;
    remove_unreachable_positions(data);
    EXPECT_EQ(data.longitude_deg.value.size(), 99U);
    EXPECT_THAT(data.latitude_deg.value, testing::Each(testing::Gt(46.0)));
}

}  // namespace
}  // namespace flightwatt::flight
