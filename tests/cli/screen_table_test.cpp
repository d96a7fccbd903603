// Tables for people: rounded, in the width of the terminal, and whole elsewhere.

#include "cli/screen_table.h"

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

const Screen narrow{true, false, 40};

TextTable energies() {
    return {{"flight", "duration_s", "energy_wh", "remark", "start_altitude_m"},
            {{"first", "1712.4", "5.017", "nothing of note", "17.0"},
             {"second", "27.5", "0.229", "was cut short by rain, landed early", "17.1"}}};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::size_t characters_in(const std::string& line) {
    return static_cast<std::size_t>(
        std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

TEST(ScreenTable, HasTheImportantColumnsAndNamesTheOthers) {
    EXPECT_EQ(screen_text(energies(), narrow, {"two flights", {"flight", "energy_wh"}}),
              "two flights\n"
              "flight  duration     energy_wh\n"
              "first   28 min 32 s      5.017\n"
              "second  27.5 s           0.229\n"
              "not shown: remark, start_altitude_m\n"
              "  (--wide shows all)\n");
}

TEST(ScreenTable, IsSplitWhereAllColumnsAreNeeded) {
    const TextTable table{{"coefficient", "take-off published", "take-off regenerated", "cruise published"},
                          {{"a0", "29.97", "30.01", "27.22"}}};
    EXPECT_EQ(screen_text(table, narrow),
              "coefficient  take-off published\n"
              "a0                        29.97\n"
              "\n"
              "coefficient  take-off regenerated\n"
              "a0                          30.01\n"
              "\n"
              "coefficient  cruise published\n"
              "a0                      27.22\n");
}

TEST(ScreenTable, KeepsSecondsBelowAMinute) {
    EXPECT_EQ(screen_text({{"n", "duration_s"}, {{"1", "27.5"}}}, narrow), "n  duration_s\n1        27.5\n");
}

TEST(ScreenTable, ShortensLongTexts) {
    auto table = energies();
    const Screen screen{true, false, 50};
    EXPECT_THAT(screen_text(table, screen, {"", {"flight", "remark"}}),
                HasSubstr("was cut short by rain, landed early\n"));
    table.rows[1][3] = "\u00e4" + std::string(50, 'x');
    EXPECT_THAT(screen_text(table, screen, {"", {"flight", "remark"}}),
                HasSubstr("  \u00e4" + std::string(36, 'x') + "...\n"));
}

TEST(ScreenTable, IsWholeWhereItIsWide) {
    const auto text = screen_text(energies(), {true, true, 20}, {"two flights", {}});
    EXPECT_THAT(text, Not(HasSubstr("not shown")));
    EXPECT_THAT(text, HasSubstr("was cut short by rain, landed early"));
    EXPECT_THAT(text, HasSubstr("17.1"));
}

TEST(ScreenTable, IsTheAlignedTableElsewhere) {
    EXPECT_EQ(screen_text(energies(), {}, {"a title", {"energy_wh"}}), to_text(energies()));
}

TEST(ScreenTable, HasTheFirstRowsOfALongOneAndSaysHowManyMore) {
    TextTable table{{"n"}, {}};
    for (int i = 0; i < 100; ++i) table.rows.push_back({std::to_string(i)});
    const auto lines = lines_of(screen_text(table, narrow, {"", {}, 9}));
    ASSERT_EQ(lines.size(), 11U);
    EXPECT_EQ(lines[9], "8");
    EXPECT_EQ(lines[10], "91 rows more, which -o FILE or a pipe gives");
}

TEST(ScreenTable, ShowsNoControlsOfNames) {
    const TextTable table{{"name"}, {{"a\x1b[31mb"}}};
    EXPECT_THAT(screen_text(table, narrow, {"t\x1b[0m", {}}), Not(HasSubstr("\x1b")));
}

TEST(ReadableTable, RoundsByTheUnitOfAColumn) {
    const auto table = readable_table(
        "# a comment\nphase,start_s,energy_wh,latitude_deg,samples,factor\n"
        "cruise,28.261000000000003,4.31795634704867,43.462213,464,0.123456\nlanding,,,,,\n");
    EXPECT_EQ(table.header.size(), 6U);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0], (std::vector<std::string>{"cruise", "28.3", "4.318", "43.46221", "464", "0.1235"}));
    EXPECT_EQ(table.rows[1], (std::vector<std::string>{"landing", "-", "-", "-", "-", "-"}));
}

/// What a command prints on a terminal of so many columns; script(1) makes it. Empty if it fails.
std::string on_terminal(std::size_t columns, const std::string& command, const std::string& environment) {
    const auto run = "script -qec 'stty cols " + std::to_string(columns) + "; " + command + "' /dev/null 2>&1";
    const auto result = test::run_shell(run, test::source_dir(), environment);
    auto text = result.code == 0 ? result.out : "";
    std::erase(text, '\r');
    return text;
}

constexpr auto plain = "LC_ALL=C.UTF-8 TERM=xterm";

class TablesOfPrograms : public testing::Test {
  protected:
    void SetUp() override {
        if (on_terminal(80, "echo here", plain).find("here") == std::string::npos) {
            GTEST_SKIP() << "no pseudo-terminal here, or no script(1)";
        }
    }

    /// Tables alone: diagnostics are not wrapped.
    static std::vector<std::string> commands() {
        const std::string logs = "logs/opterra_synthetic_0[123].data";
        return {"flightwatt segment logs/opterra_synthetic_01.data",
                "flightwatt segment logs/opterra_synthetic_01.data --explain",
                "flightwatt parse logs/opterra_synthetic_01.data",
                "flightwatt compare missions/paper/*.toml",
                "flightwatt simulate missions/paper/phased.toml",
                "flightwatt path missions/synthetic/survey-path.toml",
                "flightwatt fit " + logs + " --published fits/mechanical/opterra-table1.toml -o m.toml",
                "flightwatt battery " + logs + " -o b.toml",
                "flightwatt validate " + logs,
                "flightwatt diff missions/paper/phased.toml missions/paper/adaptive.toml",
                "flightwatt replay " + logs + " --order 1 --mission missions/paper/phased.toml",
                "flightwatt profile --check-interpolation fits/compute/tx2-detection.csv",
                "flightwatt batch " + logs + " -o out"};
    }
};

/// A command of the project's folder that writes into `folder` where it writes.
std::string with_results_in(std::string command, const std::filesystem::path& folder) {
    const auto at = command.find(" -o ");
    return at == std::string::npos ? command : command.insert(at + 4, folder.string() + "/");
}

TEST_F(TablesOfPrograms, ColourErrorsUnlessItIsNotWanted) {
    const std::string command = "flightwatt simulate nothing.toml || true";
    EXPECT_THAT(on_terminal(40, command, plain), HasSubstr("\x1b[31merror:\x1b[0m"));
    EXPECT_THAT(on_terminal(40, command, std::string(plain) + " NO_COLOR=1"), Not(HasSubstr("\x1b")));
    EXPECT_THAT(on_terminal(40, command, "TERM=dumb"), Not(HasSubstr("\x1b")));
}

TEST_F(TablesOfPrograms, WrapHelpBetweenWords) {
    for (const auto* command : {"flightwatt", "flightwatt batch --help-all", "flightwatt plan --help"})
        for (const auto& line : lines_of(on_terminal(60, command, plain)))
            if (!line.starts_with("  flightwatt ") && !line.starts_with("usage:")) {
                EXPECT_LE(characters_in(line), 60U) << command << "\n" << line;
            }
}

TEST_F(TablesOfPrograms, FitTheTerminal) {
    const auto folder = test::scratch_dir();
    for (const std::size_t columns : {80U, 130U}) {
        for (const auto& command : commands()) {
            const auto text = on_terminal(columns, with_results_in(command, folder) + " 2>/dev/null", plain);
            ASSERT_NE(text, "") << command;
            EXPECT_THAT(text, Not(HasSubstr("000000"))) << command;
            for (const auto& line : lines_of(text)) {
                // Sentences below the tables are the terminal's to wrap; a table's line has columns.
                if (line.find("  ") != std::string::npos) {
                    EXPECT_LE(characters_in(line), columns) << command << "\n" << line;
                }
            }
        }
    }
}

TEST_F(TablesOfPrograms, ShowAllWithWide) {
    const auto folder = test::scratch_dir();
    for (const auto& command : commands()) {
        const auto text = on_terminal(80, with_results_in(command, folder) + " --wide 2>/dev/null", plain);
        ASSERT_NE(text, "") << command;
        EXPECT_THAT(text, Not(HasSubstr("not shown:"))) << command;
    }
    EXPECT_THAT(on_terminal(80, "flightwatt segment logs/opterra_synthetic_01.data --wide", plain),
                HasSubstr("throttle"));
}

TEST_F(TablesOfPrograms, SayMinutesAsMinutes) {
    const std::string plan = "flightwatt plan --longest-cruise missions/paper/phased.toml";
    EXPECT_THAT(on_terminal(80, plan, plain), HasSubstr(" min "));
    EXPECT_THAT(test::run_shell(plan, test::source_dir()).out, HasSubstr("."));
    EXPECT_THAT(test::run_shell(plan, test::source_dir()).out, Not(HasSubstr(" min ")));
}

}  // namespace
}  // namespace flightwatt::cli
