// Phases, energies and messages of real logs and of small inputs that once showed faults are those that are known of
// them: every file of the corpus next to the project, by its own tool.

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {
namespace {

/// Files that are not right, with the reason. Who repairs one removes it here.
const std::map<std::string, std::string> known_faults{};

void expect_right(const std::string& folder) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto shared = test::shared_dir();
    const auto checked = test::run_shell("python3 " + test::shell_quoted(shared / "tools" / "corpus_check.py") +
                                             " --json " + test::shell_quoted(shared / "archives" / folder),
                                         test::scratch_dir());
    ASSERT_LE(checked.code, 1) << checked.err;
    const auto logs = nlohmann::json::parse(checked.out);
    ASSERT_FALSE(logs.at("files").empty());
    for (const auto& log : logs.at("files")) {
        const auto file = log.at("file").get<std::string>();
        const bool is_known = known_faults.contains(file);
        EXPECT_TRUE(is_known || log.at("right").get<bool>()) << file << ": " << log.at("wrong").dump();
        EXPECT_FALSE(is_known && log.at("right").get<bool>()) << file << " is right: remove it from known_faults";
    }
}

TEST(Corpus, RealLogsAreRight) { expect_right("wild"); }

TEST(Corpus, InputsThatShowedFaultsAreRight) { expect_right("wild-faults"); }

}  // namespace
}  // namespace flightwatt::cli
