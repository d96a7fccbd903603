#include "cli/terminal_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

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

}  // namespace
}  // namespace flightwatt::cli
