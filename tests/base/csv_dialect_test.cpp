#include "base/csv.h"
#include "helpers/rejected.h"

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Rows = std::vector<std::vector<std::string>>;

/// The rows as they are read after detection, each with its line in front.
Rows rows_of(const std::string& text, const std::vector<std::string>& names = {},
             std::optional<std::size_t> skip_lines = std::nullopt) {
    const auto header = find_csv_header(text, "a.csv", names, skip_lines);
    Rows rows;
    for_each_csv_row(
        text, "a.csv",
        [&](const CsvRowView& row) {
            auto& cells = rows.emplace_back(std::vector{std::to_string(row.line)});
            for (const auto& cell : row.cells) cells.emplace_back(cell.text);
        },
        with_decimals(header.dialect, text, "a.csv"));
    return rows;
}

std::string refusal(const std::string& text) {
    return test::rejected([&] { rows_of(text); });
}

TEST(CsvDialect, FindsTheSeparator) {
    for (const char separator : {',', ';', '\t'}) {
        const auto text = fmt::format("a{0}b\n1.5{0}2\n", separator);
        EXPECT_THAT(rows_of(text), ElementsAre(ElementsAre("1", "a", "b"), ElementsAre("2", "1.5", "2"))) << separator;
    }
    EXPECT_THAT(rows_of("a;b, in all;c\n1;2;3\n4;5;6\n").back(), ElementsAre("3", "4", "5", "6")) << "by the rows";
    EXPECT_THAT(rows_of("\"a;b\",c\n1,2\n").back(), ElementsAre("2", "1", "2")) << "not in quotes";
}

TEST(CsvDialect, ReadsDecimalCommas) {
    EXPECT_THAT(rows_of("t;p\n0,5;4,94\n1,0;1e3\n").at(1), ElementsAre("2", "0.5", "4.94"));
    EXPECT_THAT(rows_of("t\tp\n10\t-4,9\n").at(1), ElementsAre("2", "10", "-4.9"));
    EXPECT_THAT(rows_of("t,p\n10,\"-4,9\"\n").at(1), ElementsAre("2", "10", "-4.9")) << "in quotes";
    EXPECT_THAT(rows_of("t;version\n0,5;1.2\n").at(1), ElementsAre("2", "0.5", "1.2")) << "another column's points";
    EXPECT_THAT(rows_of("t;total\n0.5;1,234\n").at(1), ElementsAre("2", "0.5", "1,234")) << "thousands are no decimals";
    EXPECT_THAT(rows_of("t;place\n1;33.5 44.5\n2;a, b\n").at(2), ElementsAre("3", "2", "a, b"));
}

TEST(CsvDialect, PassesOverWhatIsBeforeTheHeader) {
    const auto after = [](const std::string& before) {
        const auto rows = rows_of(before + "time,power\n1,2\n", {"time", "power"});
        return rows.empty() ? 0 : std::stoi(rows.front().front());
    };
    EXPECT_EQ(after("sep=,\n"), 2);
    EXPECT_EQ(after("\xEF\xBB\xBF\"sep=,\"\r\n"), 2);
    EXPECT_EQ(after("Model\tX\n\n# a comment\nRange (m),0,100\n"), 5);
    EXPECT_EQ(after("5\" rotors, that is an open quote\n"), 2);
    EXPECT_THAT(rows_of("time, 2\ntime,power\n1,2\n", {"time"}, 1).front(), ElementsAre("2", "time", "power"));
    EXPECT_THAT(rows_of("sep=|\na|b\n1|2\n").back(), ElementsAre("3", "1", "2"));
}

TEST(CsvDialect, FindsNamesWithUnits) {
    const auto header = find_csv_header("x\nTime (us), Alt[m]\n", "a.csv", {"Time", "Alt"});
    EXPECT_TRUE(header.has_all);
    EXPECT_EQ(header.dialect.lines_before, 1U);
    EXPECT_FALSE(find_csv_header("Time (us),b\n", "a.csv", {"Time", "Alt"}).has_all);
    EXPECT_TRUE(find_csv_header("", "a.csv", {"Time"}).columns.empty());
}

TEST(CsvDialect, ReadsLinesThatEndByCarriageReturn) {
    EXPECT_THAT(rows_of("a,b\r1,2\r3,4\r"),
                ElementsAre(ElementsAre("1", "a", "b"), ElementsAre("2", "1", "2"), ElementsAre("3", "3", "4")));
    EXPECT_THAT(rows_of("a,b\r\n1,2\r\n").back(), ElementsAre("2", "1", "2"));
}

TEST(CsvDialect, RefusesWhatHasTwoReadings) {
    EXPECT_THAT(refusal("a,b;c\n1,2;3\n4,5;6\n"),
                HasSubstr("a.csv:1: cells may be separated by ',' or ';'; state it in a first line sep=;"));
    EXPECT_THAT(refusal("t;p\n1;1,234\n2;5,678\n"),
                HasSubstr("a.csv:2:3: '1,234' may have a decimal comma or a separator of thousands"));
    EXPECT_THAT(refusal("t;p\n1;1,5\n2;2.5\n"),
                HasSubstr("a.csv:3:3: '2.5': its column has decimals with commas and with points"));
    EXPECT_THAT(refusal("t;p\n1;1.234,5\n"), HasSubstr("a.csv:2:3: '1.234,5'"));
    EXPECT_EQ(refusal("\xFF\xFE"
                      "t"),
              "a.csv: is a text in UTF-16; save it as UTF-8");
    EXPECT_THAT(refusal("t,p\n0,5,1,5\n"), HasSubstr("a.csv:2: 4 cells, expected 2 as in the first line; if commas are "
                                                     "its decimals too, separate the cells by semicolons"));
}

}  // namespace
}  // namespace flightwatt
