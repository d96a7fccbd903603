#include "live/decision_command.h"

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

constexpr int long_ms = 60'000;

TEST(DecisionCommand, RunsWithTheDecisionInItsEnvironment) {
    const auto out = test::scratch_dir() / "out";
    DecisionCommand command("printf '%s' \"$FLIGHTWATT_RUN\" > " + test::shell_quoted(out));
    command.run({{"FLIGHTWATT_RUN", "first"}});
    EXPECT_TRUE(command.wait(long_ms));
    EXPECT_EQ(read_file(out), "first");
    EXPECT_FALSE(command.poll());
}

TEST(DecisionCommand, RunsOneAtATimeAndThenTheLatest) {
    const auto folder = test::scratch_dir();
    DecisionCommand command("cd " + test::shell_quoted(folder) +
                            "; until test -e go; do sleep 0.01; done; echo $FLIGHTWATT_RUN >> out");
    for (const auto* run : {"1", "2", "3"}) command.run({{"FLIGHTWATT_RUN", run}});
    EXPECT_FALSE(command.wait(20)) << "the first still waits";
    write_file_atomically(folder / "go", "");
    EXPECT_TRUE(command.wait(long_ms));
    EXPECT_EQ(read_file(folder / "out"), "1\n3\n");
}

TEST(DecisionCommand, SaysHowItEnded) {
    DecisionCommand fails("exit 3");
    fails.run({});
    EXPECT_TRUE(fails.wait(long_ms));
    EXPECT_EQ(fails.poll(), "exit code 3");
    DecisionCommand killed("kill -KILL $$");
    killed.run({});
    EXPECT_TRUE(killed.wait(long_ms));
    EXPECT_EQ(killed.poll(), "ended by SIGKILL");
}

}  // namespace
}  // namespace flightwatt::live
