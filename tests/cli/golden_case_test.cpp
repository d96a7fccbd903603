#include "helpers/golden_case.h"

#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

const std::string table =
    "flight                  cruise s  cruise W  energy Wh  samples\n"
    "opterra_synthetic_01         570     27.31      5.017      536\n"
    "a0 30.01, xi 0.1516: 27.25 W of 3 flights, below 0 with probability 0.2880 (-1.5e-07).\n";

bool passes(const std::string& actual, const std::string& expected = table) {
    return with_expected_numbers(actual, expected) == expected;
}

std::string changed(const std::string& from, const std::string& to) {
    auto text = table;
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("not in the table: " + from);
    return text.replace(at, from.size(), to);
}

TEST(GoldenComparison, PassesTheSameText) { EXPECT_TRUE(passes(table)); }

TEST(GoldenComparison, PassesTheLastDigitRoundedTheOtherWay) {
    EXPECT_TRUE(passes(changed("27.31", "27.32")));
    EXPECT_TRUE(passes(changed("5.017", "5.016")));
    EXPECT_TRUE(passes(changed("0.1516", "0.1517")));
    EXPECT_TRUE(passes(changed("0.2880", "0.2879")));
}

TEST(GoldenComparison, FailsOnAChangedNumber) {
    EXPECT_FALSE(passes(changed("27.31", "27.33")));
    EXPECT_FALSE(passes(changed("5.017", "5.117")));
    EXPECT_FALSE(passes(changed("30.01", "-30.01")));
    EXPECT_FALSE(passes(changed("-1.5e-07", "-1.6e-07")));
    EXPECT_FALSE(passes(changed("-1.5e-07", "-1.5e-06")));
    EXPECT_FALSE(passes(changed("27.31", "  nan")));
}

TEST(GoldenComparison, FailsOnOneUnitOfFewDigits) {
    EXPECT_FALSE(passes("1.5 %\n", "1.6 %\n"));
    EXPECT_FALSE(passes("0.05\n", "0.04\n"));
    EXPECT_FALSE(passes("0.000\n", "0.001\n"));
}

TEST(GoldenComparison, TakesLongNumbersWithinOneMillionth) {
    EXPECT_TRUE(passes("\"sd\": 1.9188022402399498\n", "\"sd\": 1.9188022402399001\n"));
    EXPECT_TRUE(passes("\"sd\": 1.9188,\n", "\"sd\": 1.9188000000000001,\n"));
    EXPECT_TRUE(passes("5.0\n", "4.9999999\n"));
    EXPECT_FALSE(passes("\"sd\": 1.91881\n", "\"sd\": 1.91879876543\n"));
}

TEST(GoldenComparison, FailsOnAChangedCount) {
    EXPECT_FALSE(passes(changed("536", "537")));
    EXPECT_FALSE(passes(changed("570", "571")));
    EXPECT_FALSE(passes("a.csv:12:7: error\n", "a.csv:12:8: error\n"));
    EXPECT_FALSE(passes("1000000\n", "1000001\n"));
    EXPECT_FALSE(passes("5\n", "5.0\n"));
}

TEST(GoldenComparison, FailsOnAChangedWordOrUnit) {
    EXPECT_FALSE(passes(changed("probability", "chance")));
    EXPECT_FALSE(passes(changed("27.25 W", "27.25 kW")));
    EXPECT_FALSE(passes(changed("27.25 W", "27.25 %")));
    EXPECT_FALSE(passes(changed("energy Wh", "energy mWh")));
    EXPECT_FALSE(passes("27.251s\n", "27.252s\n")) << "a number in a word is a name";
    EXPECT_FALSE(passes("version 10.200.1\n", "version 10.201.1\n"));
    EXPECT_FALSE(passes("20_07_05.1001\n", "20_07_05.1002\n"));
}

TEST(GoldenComparison, FailsOnAMissingOrAddedLine) {
    const auto second = table.find('\n') + 1;
    const auto third = table.find('\n', second) + 1;
    EXPECT_FALSE(passes(table.substr(0, second) + table.substr(third)));
    EXPECT_FALSE(passes(table.substr(0, third)));
    EXPECT_FALSE(passes(table + "\n"));
    EXPECT_FALSE(passes(table.substr(0, table.size() - 1)));
    EXPECT_FALSE(passes(""));
    EXPECT_FALSE(passes("printed\n", ""));
}

TEST(GoldenComparison, FailsOnChangedBlanks) {
    EXPECT_FALSE(passes(changed("570     27.31", "570    27.31")));
    EXPECT_FALSE(passes(changed("27.25 W", "27.25  W")));
}

TEST(GoldenComparison, FollowsThePaddingOfANumberThatPrintsLonger) {
    EXPECT_TRUE(passes("a  0.12345678  1\n", "a   0.1234568  1\n"));
    EXPECT_TRUE(passes("a 0.12345678  1\n", "a 0.1234568   1\n"));
    EXPECT_TRUE(passes("is 0.12345678 W\n", "is 0.1234568 W\n")) << "not in a table";
    EXPECT_FALSE(passes("a     0.12345678  1\n", "a   0.1234568  1\n"));
}

TEST(GoldenComparison, ReadsASignOnlyWhereOneCanStand) {
    EXPECT_TRUE(passes("(-1.2345)\n", "(-1.2346)\n"));
    EXPECT_TRUE(passes("1.2345-2.3456\n", "1.2346-2.3457\n"));
    EXPECT_FALSE(passes("1.2345 2.3456\n", "1.2345-2.3456\n"));
    EXPECT_TRUE(passes("ends at 1.2345.\n", "ends at 1.2346.\n"));
}

GoldenCase small_case() { return {"true\n", false, {"0", "1.2345 W\n", ""}}; }

TEST(GoldenCase, NamesThePartsThatDiffer) {
    EXPECT_EQ(differing_parts(small_case(), {"0", "1.2346 W\n", ""}), std::vector<std::string>());
    EXPECT_EQ(differing_parts(small_case(), {"1", "1.2346 V\n", "no\n"}),
              (std::vector<std::string>{"exit", "stdout", "stderr"}));
}

TEST(GoldenCase, ComparesEveryByteWhereItAsksForThat) {
    auto exact = small_case();
    exact.exact = true;
    EXPECT_EQ(differing_parts(exact, {"0", "1.2345 W\n", ""}), std::vector<std::string>());
    EXPECT_EQ(differing_parts(exact, {"0", "1.2346 W\n", ""}), std::vector<std::string>{"stdout"});
}

TEST(GoldenCase, IsReadAsItIsWritten) {
    const GoldenCase golden{"one\ntwo\n", true, {"3", "--- out\n\nx\n", "printed\n"}};
    const auto path = write_text(scratch_dir() / "a.case", to_text(golden));
    const auto read = read_golden_case(path);
    EXPECT_EQ(read.command, golden.command);
    EXPECT_TRUE(read.exact);
    EXPECT_EQ(read.expected.exit_code, "3");
    EXPECT_EQ(read.expected.stdout_text, golden.expected.stdout_text);
    EXPECT_EQ(read.expected.stderr_text, golden.expected.stderr_text);
}

TEST(GoldenCase, RefusesWhatItCannotHold) {
    auto golden = small_case();
    golden.expected.stdout_text = "no line feed";
    EXPECT_THROW(to_text(golden), std::invalid_argument);
    golden.expected.stdout_text = "--- stderr\n";
    EXPECT_THROW(to_text(golden), std::invalid_argument);
}

TEST(GoldenCase, RefusesAFileThatIsNone) {
    const auto folder = scratch_dir();
    const auto reading = [&](const char* text) {
        return rejected([&] { read_golden_case(write_text(folder / "a.case", text)); }, folder);
    };
    EXPECT_EQ(reading("true\n"), "a.case:1:1: expected '--- command'");
    EXPECT_EQ(reading("--- exit\n0\n"), "a.case:2:1: has no '--- command'");
    EXPECT_EQ(reading("--- command\ntrue\n--- command\n"), "a.case:3:1: --- command is given twice");
}

}  // namespace
}  // namespace flightwatt::test
