// Tables and CSV of records that are JSON.

#include "cli/output/records.h"

#include "base/text_table.h"

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

Json two_records() {
    return {{{"name", "a"}, {"energy_wh", 1.23456}, {"samples", 7}, {"range", {{"low", 0.5}}}, {"ends", {3.0, 4.0}}},
            {{"name", "b, c"}, {"energy_wh", nullptr}, {"samples", 12}, {"kept", true}}};
}

TEST(TableOf, NamesFieldFormAndHeadingOfEachColumn) {
    const auto table = table_of(
        two_records(), {"name: flight", "energy_wh .3f: energy [Wh]", "samples", "range/low .1f", "ends/1 .0f"});
    EXPECT_EQ(table.header, (std::vector<std::string>{"flight", "energy [Wh]", "samples", "range/low", "ends/1"}));
    EXPECT_EQ(table.rows[0], (std::vector<std::string>{"a", "1.235", "7", "0.5", "4"}));
    EXPECT_EQ(table.rows[1], (std::vector<std::string>{"b, c", "-", "12", "-", "-"}));
}

TEST(TableOf, LeavesOutRareColumnsThatNoRecordHas) {
    const auto table = table_of(two_records(), {"name", "kept?", "utility?"});
    EXPECT_EQ(table.header, (std::vector<std::string>{"name", "kept"}));
    EXPECT_EQ(table.rows[1], (std::vector<std::string>{"b, c", "yes"}));
}

TEST(TableOf, HasAFormForColumnsThatNameNone) {
    EXPECT_EQ(table_of(two_records(), {"energy_wh"}).rows[0][0], "1.23456");
    EXPECT_EQ(table_of(two_records(), {"energy_wh"}, ".2f").rows[0][0], "1.23");
}

TEST(CsvOf, HasAnEmptyCellForWhatIsNotKnown) {
    EXPECT_EQ(csv_of(two_records(), {"name: flight", "energy_wh", "kept", "ends/0: low"}, 3),
              "flight,energy_wh,kept,low\na,1.23,,3\n\"b, c\",,true,\n");
}

}  // namespace
}  // namespace flightwatt::cli
