#include "base/csv.h"

#include "base/error.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void expect_error(const std::string& text, std::size_t line, std::size_t column, const std::string& message) {
    try {
        const auto table = parse_csv(text, "a.csv");
        for (const auto& row : table.rows) cell_number(table, row, column_index(table, "power_w"));
        FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().line, line) << text;
        EXPECT_EQ(error.where().column, column) << text;
        EXPECT_THAT(error.what() + (" " + error.hint()), HasSubstr(message)) << text;
    }
}

TEST(Csv, ReadsCellsWithTheirPlaces) {
    const auto table = parse_csv("# a comment\r\ntime_s,power_w\r\n\r\n1,2.5\r\n3,\"4\"", "a.csv");
    EXPECT_THAT(table.columns, ElementsAre("time_s", "power_w"));
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[0].line, 4u);
    EXPECT_EQ(table.rows[0].cells[1].column, 3u);
    EXPECT_EQ(cell_number(table, table.rows[0], 1), 2.5);
    EXPECT_EQ(cell_number(table, table.rows[1], 1), 4.0);
}

TEST(Csv, QuotedCellsGoThereAndBack) {
    const std::string odd = "a \"quoted\", cell";
    const auto table = parse_csv("name,x\n" + csv_cell(odd) + ",1\n", "a.csv");
    EXPECT_EQ(table.rows[0].cells[0].text, odd);
    EXPECT_EQ(csv_cell("plain"), "plain");
}

TEST(Csv, RowsAreReadWhereTheyStand) {
    const std::string text = "a,b,c,d\n1.5,\"use \"\"so\"\"\",,\"x,y\"\n,,,\n";
    std::vector<std::vector<std::string>> rows;
    std::vector<std::size_t> columns;
    for_each_csv_row(text, "a.csv", [&](const CsvRowView& row) {
        auto& cells = rows.emplace_back();
        for (const auto& cell : row.cells) cells.emplace_back(cell.text);
        if (row.line != 2) return;
        EXPECT_EQ(row.cells[0].text.data(), text.data() + text.find("1.5")) << "no copy";
        for (const auto& cell : row.cells) columns.push_back(cell.column);
    });
    EXPECT_THAT(rows, ElementsAre(ElementsAre("a", "b", "c", "d"), ElementsAre("1.5", "use \"so\"", "", "x,y"),
                                  ElementsAre("", "", "", "")));
    EXPECT_THAT(columns, ElementsAre(1U, 5U, 18U, 19U));
}

TEST(Csv, TrimsCellsAndNames) {
    const auto table = parse_csv(" time_s ,\tpower_w, note\n 1 , 2.5,\"a\" \n   \n3,4, \" b\"\n", "a.csv");
    EXPECT_THAT(table.columns, ElementsAre("time_s", "power_w", "note"));
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(cell_number(table, table.rows[0], 1), 2.5);
    EXPECT_EQ(table.rows[0].cells[1].column, 6U) << "where the cell begins";
    EXPECT_EQ(table.rows[0].cells[2].text, "a");
    EXPECT_EQ(table.rows[1].cells[2].text, " b") << "quotes keep blanks";
    EXPECT_EQ(csv_cell(" b"), "\" b\"");
}

TEST(Csv, EmptyCellsBehindTheLastColumnDoNotCount) {
    EXPECT_EQ(parse_csv("a,b\n1,2,\n3,4,,\n", "a.csv").rows.size(), 2U);
    expect_error("time_s,power_w\n1,2,3\n", 2, 0, "3 cells, expected 2");
}

TEST(Csv, PassesRaggedRowsOn) {
    std::vector<std::size_t> ragged;
    for_each_csv_row(
        "a,b\n1\n1,2\n1,2,3\n", "a.csv", [](const CsvRowView& row) { EXPECT_EQ(row.cells.size(), 2U); }, {},
        [&](const CsvRowView& row) { ragged.push_back(row.line); });
    EXPECT_THAT(ragged, ElementsAre(2U, 4U));
}

TEST(Csv, FindsColumnsWithTheirUnits) {
    const std::vector<std::string> columns{"Time", "Alt(m)", "speed (km/h)", "OSD.height [ft]", "h(m)", "h(ft)", "x()"};
    const auto unit_of = [&](const char* name) {
        const auto found = find_columns(columns, name);
        return found.empty() ? "none" : found.front().unit;
    };
    EXPECT_EQ(unit_of("Alt"), "m");
    EXPECT_EQ(unit_of(" speed"), "km/h");
    EXPECT_EQ(unit_of("OSD.height"), "ft");
    EXPECT_EQ(unit_of("Alt(m)"), "") << "the whole name";
    EXPECT_EQ(unit_of("alt"), "none");
    EXPECT_EQ(find_columns(columns, "h").size(), 2U);
}

TEST(Csv, RefusesBadTablesWithTheirPlace) {
    expect_error("", 0, 0, "is empty");
    expect_error("# only a comment\n", 0, 0, "is empty");
    expect_error("time_s,power_w\n1,nan\n", 2, 3, "power_w is not a finite number: 'nan'");
    expect_error("time_s,power_w\n1,2\n1,12.5x\n", 3, 3, "'12.5x'");
    expect_error("time_s,power_w\n1\n", 2, 0, "1 cells, expected 2");
    expect_error("fps;power_w\n1;2,5\n", 2, 0, "separate the cells by commas, and write decimals with a point");
    expect_error("time_s,power_w\n1,\"2\n", 2, 3, "a quote is opened and not closed");
    expect_error("time_s,power_kw\n1,2\n", 1, 0, "has no column 'power_w'");
}

TEST(Csv, RefusesWhatWouldFillTheMemory) {
    expect_error("a\n" + std::string(1'000'000, ',') + "\n", 2, 0, "has more than 1000 cells");
    EXPECT_NO_THROW(parse_csv(std::string(999, ','), "a.csv"));
    std::string rows = "a\n";
    for (int i = 0; i < 3'000'000; ++i) rows += "1\n";
    expect_error(rows, 2666667, 0, "holds more than 8000000 rows and cells");
    std::size_t count = 0;
    for_each_csv_row(rows, "a.csv", [&](const CsvRowView&) { ++count; });
    EXPECT_EQ(count, 3'000'001U) << "one at a time there is no limit";
}

TEST(CsvWriter, WritesNumbersTextsAndWhatIsAbsent) {
    CsvWriter csv({"time_s", "phase", "count", "used", "current_a"});
    csv.add(0.1, "a, b", std::size_t{3}, true, std::optional<double>());
    csv.add(1.0 / 3.0, std::string("cruise"), -1, false, std::optional<double>(2.5));
    EXPECT_EQ(csv.text(),
              "time_s,phase,count,used,current_a\n0.1,\"a, b\",3,true,\n0.3333333333333333,cruise,-1,false,2.5\n");
}

TEST(CsvWriter, RoundsToTheDigitsAskedFor) {
    CsvWriter csv({"time_s"}, 3);
    csv.add(1234.56);
    csv.add(2.0 / 3.0);
    EXPECT_EQ(csv.text(), "time_s\n1.23e+03\n0.667\n");
}

TEST(CsvWriter, RefusesARowOfAnotherLength) {
    CsvWriter csv({"a", "b"});
    EXPECT_THROW(csv.add(1), std::logic_error);
}

}  // namespace
}  // namespace flightwatt
