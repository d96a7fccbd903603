// Mistakes of beginners (mistakes.txt): each is answered by one line with place, cause and remedy.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

struct Mistake {
    std::string command;
    std::vector<std::string> expected;  ///< exit code, place, cause, remedy
};

std::vector<Mistake> read_mistakes() {
    std::vector<Mistake> mistakes;
    std::istringstream text(read_file(test::source_dir() / "tests" / "cli" / "mistakes.txt"));
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with("$ ")) {
            mistakes.push_back({line.substr(2), {}});
        } else if (!line.empty() && !line.starts_with('#')) {
            auto& expected = mistakes.back().expected;
            boost::algorithm::split(expected, line, boost::is_any_of("|"));
            for (auto& part : expected) boost::algorithm::trim(part);
        }
    }
    return mistakes;
}

/// A beginner's folder: flights, what the first commands made of them, and some other files.
void make_folder(const std::filesystem::path& folder) {
    const auto setup = fmt::format(
        R"(mkdir flights; cp {}/logs/opterra_synthetic_0[123].* flights
flightwatt batch flights -o my && flightwatt battery my --capacity 5 -o pack.toml &&
flightwatt new-mission --model my/model.toml --battery pack.toml -o mission.toml &&
flightwatt simulate mission.toml -o soc.csv && flightwatt init home || exit
head -c 60000 flights/opterra_synthetic_01.data > cut.data; cp flights/opterra_synthetic_01.log cut.log
: > empty.data; : > empty.toml; echo hello > words.txt; echo '<!DOCTYPE html><html></html>' > page.html
echo '{{ "fileType": "Plan", "mission": {{}} }}' > ground.plan; echo 'QGC WPL 110' > waypoints.txt
echo '<kml></kml>' > field.kml
printf '\243\225\200\200\131' > ardupilot.bin
printf '[sampler]\ncommand = ["echo", "5"]\n[components.detector]\ncommand = ["./detect"]\n' > specification.toml)",
        test::shell_quoted(test::source_dir()));
    const auto made = test::run_shell(setup, folder);
    ASSERT_EQ(made.code, 0) << made.err;
}

bool has_line_with(const std::string& text, const std::vector<std::string>& parts) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto has = [&](const std::string& part) { return line.find(part) != std::string::npos; };
        if (std::ranges::all_of(parts, has)) return true;
    }
    return false;
}

TEST(Mistakes, AreAnsweredWithPlaceCauseAndRemedy) {
    constexpr std::size_t at_least = 52;
    const auto folder = test::scratch_dir();
    make_folder(folder);
    const auto mistakes = read_mistakes();
    EXPECT_GE(mistakes.size(), at_least);
    for (const auto& [command, expected] : mistakes) {
        ASSERT_EQ(expected.size(), 4U) << command;
        const auto result = test::run_shell(command, folder);
        EXPECT_EQ(std::to_string(result.code), expected.front()) << command;
        EXPECT_TRUE(has_line_with(result.err, {expected.begin() + 1, expected.end()}))
            << command << "\n"
            << result.err << "lacks a line with " << fmt::format("{}", fmt::join(expected, " | "));
    }
}

}  // namespace
}  // namespace flightwatt::cli
