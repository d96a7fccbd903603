// Pictures in the terminal: where, how drawn, and those of compare and segment on a terminal of their own.

#include "cli/terminal.h"

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TerminalCapabilities with(const std::map<std::string, std::string>& variables, bool is_terminal = true) {
    return detect_capabilities(is_terminal, 120, [&](const char* name) -> const char* {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
    });
}

TEST(TerminalAbility, DrawsOnlyOnATerminalThatShowsUnicode) {
    EXPECT_TRUE(with({{"TERM", "xterm"}, {"LANG", "en_US.UTF-8"}}).draws);
    EXPECT_TRUE(with({{"TERM", "xterm"}, {"LANG", "C"}, {"LC_ALL", "C.utf8"}}).draws);
    EXPECT_FALSE(with({{"TERM", "xterm"}, {"LANG", "en_US.UTF-8"}}, false).draws);
    EXPECT_FALSE(with({{"TERM", "dumb"}, {"LANG", "en_US.UTF-8"}}).draws);
    EXPECT_FALSE(with({{"LANG", "en_US.UTF-8"}}).draws);
    EXPECT_FALSE(with({{"TERM", "xterm"}, {"LANG", "en_US.UTF-8"}, {"LC_ALL", "C"}}).draws);
    EXPECT_FALSE(with({{"TERM", "xterm"}}).draws);
}

TEST(TerminalAbility, LeavesColoursOutWhereTheyAreNotWanted) {
    EXPECT_TRUE(with({{"TERM", "xterm"}, {"LANG", "C.UTF-8"}}).colors);
    const auto plain = with({{"TERM", "xterm"}, {"LANG", "C.UTF-8"}, {"NO_COLOR", "1"}});
    EXPECT_TRUE(plain.draws);
    EXPECT_FALSE(plain.colors);
    EXPECT_EQ(plain.columns, 120U);
}

using testing::HasSubstr;
using testing::Not;

TEST(TerminalPlot, DrawsALineFromCornerToCorner) {
    TerminalPlot plot;
    plot.title = "charge";
    plot.x_label = "s";
    plot.columns = 35;
    plot.rows = 5;
    EXPECT_EQ(draw(plot, std::vector<TerminalLine>{{{0.0, 10.0}, {100.0, 0.0}, "1"}}),
              "charge\n"
              "  100 ┤⠉⠓⠦⣄⡀               \n"
              "      │    ⠉⠓⠦⣄⡀           \n"
              "   50 ┤        ⠉⠓⠦⣄⡀       \n"
              "      │            ⠉⠓⠦⣄⡀   \n"
              "    0 ┤                ⠉⠓⠦⣄ 1\n"
              "       0               10 s\n");
}

TEST(TerminalPlot, ColoursOnlyWhereItMay) {
    TerminalPlot plot;
    const std::vector<TerminalLine> lines{{{0.0, 1.0}, {50.0, 50.0}, "1"}, {{0.0, 1.0}, {20.0, 20.0}, "2"}};
    EXPECT_THAT(draw(plot, lines), Not(HasSubstr("\x1b")));
    plot.colors = true;
    EXPECT_THAT(draw(plot, lines), HasSubstr("\x1b[38;5;166m2\x1b[0m"));
}

TEST(TerminalPlot, IsEmptyWithoutRoomOrLength) {
    TerminalPlot plot;
    EXPECT_EQ(draw(plot, {}), "");
    EXPECT_EQ(draw(plot, std::vector<TerminalLine>{{{1.0}, {1.0}, ""}}), "");
    plot.columns = 30;
    EXPECT_EQ(draw(plot, std::vector<TerminalLine>{{{0.0, 1.0}, {1.0, 1.0}, ""}}), "");
}

/// What a shell command prints; script(1) gives it a terminal. Empty if it fails.
std::string printed(const std::string& environment, const std::string& command, bool on_terminal) {
    const auto run = on_terminal ? "script -qec '" + command + "' /dev/null" : command;
    const auto result = test::run_shell(run + " 2>&1", test::source_dir(), environment);
    return result.code == 0 ? result.out : "";
}

constexpr auto utf8 = "LC_ALL=C.UTF-8 TERM=xterm";
constexpr auto braille_start = "\xE2\xA0";  // of its first half
constexpr auto escape = "\x1b[";

class OnATerminal : public testing::Test {
  protected:
    void SetUp() override {
        if (printed(utf8, "echo here", true).find("here") == std::string::npos) {
            GTEST_SKIP() << "no pseudo-terminal here, or no script(1)";
        }
    }
};

TEST_F(OnATerminal, CompareDrawsTheStateOfCharge) {
    const std::string compare = "flightwatt compare missions/paper/phased.toml missions/paper/adaptive.toml";
    const auto picture = printed(utf8, compare, true);
    EXPECT_THAT(picture, HasSubstr("state of charge [%] over time"));
    EXPECT_THAT(picture, HasSubstr(braille_start));
    EXPECT_THAT(picture, HasSubstr(escape));
    EXPECT_THAT(printed(std::string(utf8) + " NO_COLOR=1", compare, true), Not(HasSubstr(escape)));
    for (const auto* plain : {"LC_ALL=C.UTF-8 TERM=dumb", "LC_ALL=C TERM=xterm"}) {
        const auto table = printed(plain, compare, true);
        EXPECT_THAT(table, HasSubstr("adaptive")) << plain;
        EXPECT_THAT(table, Not(HasSubstr(braille_start))) << plain;
    }
    EXPECT_THAT(printed(utf8, compare, false), Not(HasSubstr(braille_start)));
    EXPECT_THAT(printed(utf8, compare + " --markdown", true), Not(HasSubstr(braille_start)));
}

TEST_F(OnATerminal, SegmentDrawsTheAltitude) {
    const std::string segment = "flightwatt segment logs/opterra_synthetic_01.data";
    const auto picture = printed(utf8, segment, true);
    EXPECT_THAT(picture, HasSubstr("altitude [m] over time"));
    EXPECT_THAT(picture, HasSubstr(braille_start));
    EXPECT_THAT(picture, HasSubstr("cruise 92 to 662 s"));
    EXPECT_THAT(printed(utf8, segment, false), Not(HasSubstr(braille_start)));
    EXPECT_THAT(printed(utf8, segment + " --json", true), Not(HasSubstr(braille_start)));
}

}  // namespace
}  // namespace flightwatt::cli
