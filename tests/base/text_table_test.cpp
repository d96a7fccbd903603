#include "base/text_table.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

const TextTable table{{"flight", "power_w"}, {{"a, b", "1.5"}, {"Ünal", "-"}}};

TEST(TextTable, AlignsNumbersToTheRightAndCountsCodePoints) {
    EXPECT_EQ(to_text(table), "flight  power_w\na, b        1.5\nÜnal          -\n");
}

TEST(TextTable, IsMarkdownAndCsvToo) {
    EXPECT_EQ(to_markdown(table), "| flight | power_w |\n|---|---:|\n| a, b | 1.5 |\n| Ünal | - |\n");
    EXPECT_EQ(to_csv(table), "flight,power_w\n\"a, b\",1.5\nÜnal,-\n");
}

TEST(TextTable, KeepsOddNamesFromBreakingTheTable) {
    const TextTable odd{{"name"}, {{"two\nlines | one"}}};
    EXPECT_EQ(to_text(odd), "name\ntwo lines | one\n");
    EXPECT_EQ(to_markdown(odd), "| name |\n|---|\n| two lines \\| one |\n");
}

TEST(Fixed, IsADashForWhatIsNotKnown) {
    EXPECT_EQ(fixed(1.25, 3), "1.250");
    EXPECT_EQ(fixed(std::nullopt, 3), "-");
}

}  // namespace
}  // namespace flightwatt
