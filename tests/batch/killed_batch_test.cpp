// The program itself, killed and interrupted in the middle of a batch: what it ends with must not show.

#include "helpers/running_program.h"
#include "helpers/sample_logs.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace flightwatt::batch {
namespace {

using test::contents;
using testing::HasSubstr;

constexpr int logs = 12;

class KilledBatch : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::mt19937 random{1};  ///< for the moments of the signals

    /// Twelve logs, no two of the same content.
    void SetUp() override {
        for (int i = 0; i < logs; ++i) {
            const auto copy = test::copy_sample(1 + i % 6, folder / "in", "flight_" + std::to_string(10 + i));
            std::ofstream(copy, std::ios::app) << "9999." << i << " 7 PING\n";
        }
    }

    /// Starts `flightwatt-batch in -o OUT --jobs JOBS`; what it states goes to the file stderr.
    ::pid_t start(const std::string& out, unsigned jobs) {
        return test::start_program("flightwatt-batch", {"in", "-o", out, "--jobs", std::to_string(jobs)}, folder);
    }

    std::map<std::string, std::string> left_alone(unsigned jobs) {
        const auto out = "alone" + std::to_string(jobs);
        EXPECT_EQ(test::wait_status_of(start(out, jobs)), 0);
        return contents(folder / out);
    }

    int records(const std::string& out) {
        int count = 0;
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(folder / out / "flights", none)) {
            count += entry.path().string().ends_with(".record.json") ? 1 : 0;
        }
        return count;
    }

    /// Starts a batch and sends it a signal a little after it has `done` records. Returns its status, which is 0 where
    /// on a busy machine the batch ended first.
    int stop_after(const std::string& out, int done, int signal) {
        const auto child = start(out, 1);
        for (int look = 0; records(out) < done && look < 600000; ++look) {
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
        ::kill(child, signal);
        return test::wait_status_of(child);
    }
};

TEST_F(KilledBatch, WritesTheSameBytesWithAnyNumberOfJobs) {
    const auto whole = left_alone(1);
    EXPECT_EQ(whole.size(), 3U * logs + 8U);
    EXPECT_EQ(left_alone(2), whole);
    EXPECT_EQ(left_alone(5), whole);
}

TEST_F(KilledBatch, EndsWithTheSameBytesAfterKills) {
    const auto whole = left_alone(2);
    int killed = 0;
    for (const int done : {2, 5, 8}) {
        killed += WIFSIGNALED(stop_after("out", done, SIGKILL)) ? 1 : 0;
        for (const auto& [name, content] : contents(folder / "out")) {
            EXPECT_TRUE(whole.contains(name) || name.starts_with(temporary_folder)) << name << " is in no list";
        }
    }
    EXPECT_GE(killed, 1);  // a machine that looks away for long enough may allow one to finish
    EXPECT_EQ(test::wait_status_of(start("out", 2)), 0);
    EXPECT_EQ(contents(folder / "out"), whole);
}

TEST_F(KilledBatch, GoesOnAfterCtrlC) {
    const auto whole = left_alone(2);
    int status = 0;
    for (int tries = 0; status == 0 && tries < 20; ++tries) {
        std::filesystem::remove_all(folder / "out");
        status = stop_after("out", 3, SIGINT);
    }
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(WTERMSIG(status), SIGINT);
    for (const auto& [name, content] : contents(folder / "out")) {
        if (name.starts_with(temporary_folder)) continue;
        ASSERT_TRUE(whole.contains(name)) << name;  // nothing half-written
        EXPECT_EQ(content, whole.at(name)) << name;
    }
    EXPECT_EQ(test::wait_status_of(start("out", 2)), 0);
    EXPECT_THAT(read_file(folder / "stderr"), HasSubstr("flight_10: up to date"));
    EXPECT_EQ(contents(folder / "out"), whole);
}

}  // namespace
}  // namespace flightwatt::batch
