#include "cli/terminal.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TerminalAbility with(const std::map<std::string, std::string>& variables, bool is_terminal = true) {
    return ability_of(is_terminal, 120, [&](const char* name) -> const char* {
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

}  // namespace
}  // namespace flightwatt::cli
