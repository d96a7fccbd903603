#include "telemetry/text/row_storage.h"

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

TEST(RowStorage, ExpectsTheRateSoFarOfTheRest) {
    EXPECT_EQ(rows_to_reserve(0, 0, 1000000), 64u);
    EXPECT_EQ(rows_to_reserve(64, 100, 1000000), 128u) << "too few rows tell no rate";
    EXPECT_EQ(rows_to_reserve(2000, 100000, 1000000), 22000u) << "ten times as many and a tenth";
    EXPECT_EQ(rows_to_reserve(2000, 1000000, 1000000), 3000u) << "always more than there are";
}

TEST(RowStorage, MakesRoomInEveryColumn) {
    MessageTable table{"ENERGY", {1.0}, {{"power", {}, {30.0}}}};
    constexpr std::size_t several_large_pages = 1 << 20;
    reserve_rows(table, several_large_pages);
    EXPECT_GE(table.time_s.capacity(), several_large_pages);
    EXPECT_GE(table.columns[0].values.capacity(), several_large_pages);
    EXPECT_EQ(table.time_s, std::vector<double>{1.0});
    EXPECT_EQ(table.columns[0].values, std::vector<double>{30.0});
}

}  // namespace
}  // namespace flightwatt::telemetry
