// Completion in the shells themselves, and man pages: both are made of what the programs state of their options.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::set<std::string> lines_of(const std::string& text) {
    std::set<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.insert(line);
    return lines;
}

bool has_shell(const std::string& shell) {
    return test::run_shell("command -v " + shell, test::binary_dir()).code == 0;
}

/// Stages and the options of one, as the programs list them.
std::vector<std::string> stages() {
    std::vector<std::string> names;
    std::istringstream in(test::run_shell("flightwatt --list-stages", test::binary_dir()).out);
    for (std::string line; std::getline(in, line);) names.push_back(line.substr(0, line.find('\t')));
    return names;
}

/// What a shell offers for a line that ends where the cursor is, a candidate a line.
class Shell : public testing::TestWithParam<const char*> {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    void SetUp() override {
        if (!has_shell(GetParam())) GTEST_SKIP() << "no " << GetParam() << " here";
        for (const auto* file : {"m.toml", "flight.data", "flight.log", "picture.png", "p.csv"})
            write_file_atomically(folder / file, "");
        make_directories(folder / "logs");
    }

    std::set<std::string> offered(const std::string& line) const {
        const auto completions = (test::source_dir() / "completions").string();
        std::string command;
        const std::string shell = GetParam();
        if (shell == "bash") {
            command = "bash --norc -c 'source " + completions + "/flightwatt.bash; read -ra COMP_WORDS <<< \"" + line +
                      "\"; [[ \"" + line +
                      "\" == *\" \" ]] && COMP_WORDS+=(\"\"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _flightwatt; "
                      "printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
        } else if (shell == "fish") {
            command = "HOME=. XDG_CONFIG_HOME=. XDG_DATA_HOME=. fish --no-config -c 'source " + completions +
                      "/flightwatt.fish; complete -C \"" + line + "\"' | cut -f 1";
        } else {
            // zsh completes in an interactive shell alone, so its words are caught where they are added.
            command =
                "zsh -f -c 'fpath=(" + completions +
                " $fpath); compadd() { print -l -- ${(P)@[-1]}; }; _describe() { print -l -- ${${(P)@[-1]}%%:*}; }; "
                "_files() { shift; print -l -- ${~1}(N) *(/N); }; setopt extendedglob; words=(${(z):-" +
                line + "}); [[ \"" + line + "\" == *\" \" ]] && words+=(\"\"); CURRENT=$#words; source " + completions +
                "/_flightwatt'";
        }
        const auto result = test::run_shell(command, folder);
        EXPECT_EQ(result.code, 0) << command << "\n" << result.err;
        return lines_of(result.out);
    }
};

TEST_P(Shell, OffersStages) {
    const auto words = offered("flightwatt ");
    for (const auto& stage : stages()) EXPECT_THAT(words, Contains(stage));
    EXPECT_THAT(words, Contains("help"));
}

TEST_P(Shell, OffersTheOptionsOfAStage) {
    const auto words = offered("flightwatt fit --");
    for (const auto* option : {"--published", "--errors", "--output", "--help"}) EXPECT_THAT(words, Contains(option));
    EXPECT_THAT(words, Not(Contains("--probability")));
    EXPECT_THAT(offered("flightwatt plan --"), Contains("--probability"));
}

TEST_P(Shell, OffersFilesThatAreRead) {
    const auto words = offered("flightwatt fit ");
    for (const auto* file : {"m.toml", "flight.data", "flight.log", "p.csv"}) EXPECT_THAT(words, Contains(file));
    EXPECT_THAT(words, Not(Contains("picture.png")));
}

TEST_P(Shell, OffersStagesToHelp) { EXPECT_THAT(offered("flightwatt help "), Contains("plan")); }

INSTANTIATE_TEST_SUITE_P(Completion, Shell, testing::Values("bash", "fish", "zsh"),
                         [](const auto& param) { return std::string(param.param); });

/// Makes the pages again.
class ManPages : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    void SetUp() override {
        const auto made = test::run_shell(test::shell_quoted(test::source_dir() / "cmake" / "make_man") +
                                              " --programs " + test::shell_quoted(test::programs_dir()) + " --into " +
                                              test::shell_quoted(folder / "man"),
                                          folder);
        ASSERT_EQ(made.code, 0) << made.err;
    }
};

TEST_F(ManPages, HoldEveryOptionOfEveryProgram) {
    std::size_t options = 0;
    for (const auto& stage : stages()) {
        auto page = read_file(folder / "man" / ("flightwatt-" + stage + ".1"));
        std::erase(page, '\\');
        std::istringstream in(test::run_shell("flightwatt-" + stage + " --list-options", folder).out);
        for (std::string line; std::getline(in, line); ++options) {
            const auto name = line.substr(0, line.find('\t'));
            EXPECT_THAT(page, HasSubstr("fB" + name + "fP")) << stage;
        }
    }
    EXPECT_GT(options, 150U);
}

TEST_F(ManPages, AreWithoutWarnings) {
    if (!has_shell("mandoc")) GTEST_SKIP() << "no mandoc here";
    const auto checked = test::run_shell("mandoc -Tlint -Wwarning man/*.1", folder);
    EXPECT_EQ(checked.out + checked.err, "");
    EXPECT_EQ(checked.code, 0);
    EXPECT_THAT(test::run_shell("mandoc -Tutf8 man/flightwatt-fit.1 | col -b", folder).out, HasSubstr("--published"));
}

}  // namespace
}  // namespace flightwatt::cli
