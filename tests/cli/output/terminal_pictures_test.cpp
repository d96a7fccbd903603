// compare and segment on a terminal of their own, and elsewhere.

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

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
