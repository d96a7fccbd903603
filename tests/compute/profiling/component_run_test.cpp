// What becomes of components that do not behave: each is recorded, and nothing of it stays behind.

#include "compute/profiling/component_run.h"

#include "base/atomic_file.h"
#include "compute/processes/supervised_processes.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

using testing::HasSubstr;

PowerSampler constant_sampler(double power_w) {
    PowerSampler sampler;
    sampler.read = [power_w] { return std::vector<PowerReading>{{std::chrono::steady_clock::now(), power_w}}; };
    return sampler;
}

class MisbehavingComponent : public testing::Test {
  protected:
    std::string marker = test::new_marker();

    /// Runs a shell script that names the marker wherever it sleeps.
    ComponentRun run(const std::string& script, const ProfileTiming& timing) const {
        auto sampler = constant_sampler(3.0);
        RunContext frame;
        frame.sampler = &sampler;
        frame.interval_s = 0.01;
        frame.kill_timeout_s = patience_s;
        frame.output = output;
        auto whole = script;
        for (auto at = whole.find("FOREVER"); at != std::string::npos; at = whole.find("FOREVER")) {
            whole.replace(at, 7, "sleep " + marker);
        }
        return run_component({{"sh", "-c", whole}}, timing, frame);
    }
    std::filesystem::path output;
    double patience_s = 10.0;  ///< with those that follow SIGTERM, as soon as the machine allows it
    void expect_nothing_left() const { EXPECT_EQ(test::processes_with(marker), 0); }
};

// A slow machine may start the component late: where a test waits for what that does, it has a minute.
constexpr ProfileTiming short_time{0.15, 0.05, 600.0};
constexpr ProfileTiming long_time{60.0, 0.0, 600.0};
constexpr ProfileTiming until_it_ends{std::nullopt, 0.0, 60.0};
constexpr ProfileTiming until_too_late{std::nullopt, 0.0, 0.3};

TEST_F(MisbehavingComponent, IsSampledForItsTimeAfterTheWarmUp) {
    const auto done = run("FOREVER", {1.0, 0.05, 600.0});
    EXPECT_EQ(done.status, RunStatus::ok) << done.note;
    EXPECT_GE(done.duration_s, 1.0 - 1e-9);  // more where the first sample comes late
    ASSERT_FALSE(done.trace.time_s.empty());
    EXPECT_GE(done.trace.time_s.front(), 0.05);
    EXPECT_LE(done.trace.time_s.back(), done.duration_s + 0.05 + 1e-9);
    expect_nothing_left();
}

TEST_F(MisbehavingComponent, MayEndByItself) {
    const auto done = run("sleep 0.5", until_it_ends);
    EXPECT_EQ(done.status, RunStatus::ok) << done.note;
    EXPECT_GE(done.duration_s, 0.49);
}

TEST_F(MisbehavingComponent, Hangs) {
    const auto done = run("FOREVER", until_too_late);
    EXPECT_EQ(done.status, RunStatus::timed_out);
    EXPECT_EQ(done.note, "still ran after 0.3 s");
    expect_nothing_left();
}

TEST_F(MisbehavingComponent, HangsAndIgnoresSigterm) {
    patience_s = 0.2;
    const auto done = run("trap '' TERM; FOREVER; FOREVER", {std::nullopt, 0.0, 2.0});
    EXPECT_EQ(done.status, RunStatus::timed_out);
    EXPECT_THAT(done.note, HasSubstr("did not end by SIGTERM, killed"));
    expect_nothing_left();
}

TEST_F(MisbehavingComponent, Crashes) {
    EXPECT_EQ(run("exit 3", long_time).note, "exit code 3");
    const auto crashed = run("kill -SEGV $$", long_time);
    EXPECT_EQ(crashed.status, RunStatus::failed);
    EXPECT_EQ(crashed.note, "killed by SIGSEGV");
    EXPECT_EQ(run("exit 0", long_time).status, RunStatus::ended_early);
}

TEST_F(MisbehavingComponent, LeavesAChildBehind) {
    const auto done = run("FOREVER & exit 1", long_time);
    EXPECT_EQ(done.status, RunStatus::failed);
    EXPECT_EQ(done.note, "exit code 1; left processes behind, ended");
    expect_nothing_left();
}

TEST_F(MisbehavingComponent, StartsAWorkerInASessionOfItsOwn) {
    EXPECT_EQ(run("setsid FOREVER & FOREVER", short_time).note, "");
    expect_nothing_left();
    const auto started = (test::scratch_dir() / "started").string();
    const auto left = run("setsid sh -c 'touch " + started + "; FOREVER; true' & while [ ! -e " + started +
                              " ]; do sleep 0.01; done; exit 1",
                          long_time);
    EXPECT_EQ(left.note, "exit code 1; left processes behind, ended");
    expect_nothing_left();
}

TEST_F(MisbehavingComponent, PrintsWithoutEnd) {
    output = test::scratch_dir() / "out.txt";
    run("echo BEGIN; head -c 5000000 /dev/zero; echo END >&2", until_it_ends);
    const auto text = read_file(output);
    EXPECT_THAT(text, testing::StartsWith("BEGIN\n"));
    EXPECT_THAT(text, HasSubstr("\n[4868938 bytes are left out here]\n"));
    EXPECT_THAT(text, testing::EndsWith("END\n"));
    EXPECT_EQ(text.size(), 2 * kept_output_bytes + 35);
    // All that a pipe does not hold, while it is ended.
    EXPECT_EQ(run("trap 'head -c 200000 /dev/zero; exit' TERM; while :; do sleep 0.01; done", short_time).note, "");
    run("true", until_it_ends);
    EXPECT_FALSE(std::filesystem::exists(output)) << "of the run before";
}

TEST_F(MisbehavingComponent, ForksOnAndOn) {
    patience_s = 0.2;  // what is forked in the meantime may miss SIGTERM
    run("while :; do FOREVER & sleep 0.005; done", short_time);
    expect_nothing_left();
}

TEST(ComponentRun, CannotBeStarted) {
    auto sampler = constant_sampler(3.0);
    RunContext frame;
    frame.sampler = &sampler;
    const auto done = run_component({{"there-is-no-such-component"}}, short_time, frame);
    EXPECT_EQ(done.status, RunStatus::not_started);
    EXPECT_EQ(done.note, "cannot be started: No such file or directory");
}

TEST(ComponentRun, CannotBeStartedHoweverShortTheRun) {
    auto sampler = constant_sampler(3.0);
    RunContext frame;
    frame.sampler = &sampler;
    ProfileTiming over_at_once;
    over_at_once.duration_s = 1e-9;
    EXPECT_EQ(run_component({{"there-is-no-such-component"}}, over_at_once, frame).status, RunStatus::not_started);
}

TEST(ComponentRun, EndsWithTheFirstOfThoseThatRunTogether) {
    auto sampler = constant_sampler(3.0);
    RunContext frame;
    frame.sampler = &sampler;
    const auto marker = test::new_marker();
    const auto done = run_component({{"sleep", marker}, {"sleep", "0.5"}}, until_it_ends, frame);
    EXPECT_EQ(done.status, RunStatus::ok) << done.note;
    EXPECT_EQ(test::processes_with(marker), 0);
}

TEST(ComponentRun, ASamplerThatBreaksLeavesNothingRunning) {
    PowerSampler sampler;
    int calls = 0;
    sampler.read = [&calls]() -> std::vector<PowerReading> {
        if (++calls < 3) return {};
        throw NoResultError("the meter is absent");
    };
    RunContext frame;
    frame.sampler = &sampler;
    frame.interval_s = 0.01;
    const auto marker = test::new_marker();
    EXPECT_THROW(run_component({{"sleep", marker}}, short_time, frame), NoResultError);
    EXPECT_EQ(test::processes_with(marker), 0);
}

/// A sampler that gives `count` readings at every `period`-th call.
PowerSampler bursting_sampler(int period, std::size_t count) {
    PowerSampler sampler;
    sampler.read = [period, count, calls = 0]() mutable {
        std::vector<PowerReading> readings;
        if (++calls % period == 0)
            while (readings.size() < count) readings.push_back({std::chrono::steady_clock::now(), 3.0});
        return readings;
    };
    return sampler;
}

TEST(ComponentRun, IsRefusedWhereSamplesComeInBursts) {
    EXPECT_TRUE(come_in_bursts(608, 19));
    EXPECT_FALSE(come_in_bursts(607, 19));
    EXPECT_FALSE(come_in_bursts(640, 20));
    EXPECT_FALSE(come_in_bursts(1, 1));
    auto sampler = bursting_sampler(5, 50);
    RunContext frame;
    frame.sampler = &sampler;
    frame.interval_s = 0.01;
    const auto done = run_component({}, short_time, frame);
    EXPECT_EQ(done.status, RunStatus::failed);
    EXPECT_THAT(done.note, testing::ContainsRegex("[0-9]+0 samples came in [0-9]+ bursts"));
}

TEST(ComponentRun, LastsUntilItsFirstSample) {
    auto sampler = bursting_sampler(30, 1);
    RunContext frame;
    frame.sampler = &sampler;
    frame.interval_s = 0.01;
    ProfileTiming shorter;
    shorter.duration_s = 0.1;
    const auto done = run_component({}, shorter, frame);
    ASSERT_EQ(done.status, RunStatus::ok) << done.note;
    EXPECT_EQ(done.trace.time_s, std::vector<double>{done.duration_s});
    EXPECT_GT(done.duration_s, 0.1);
}

TEST(ComponentRun, OfARecording) {
    const PowerTrace recording{{10.0, 10.5, 11.0, 11.5, 12.0}, {1, 2, 3, 4, 5}};
    const auto all = run_of_recording(recording, {}, 0.1);
    EXPECT_EQ(all.trace.time_s.size(), 5U);
    EXPECT_DOUBLE_EQ(all.duration_s, 2.5);
    const auto part = run_of_recording(recording, {1.0, 0.5, 600.0}, 0.1);
    EXPECT_EQ(part.status, RunStatus::ok);
    EXPECT_EQ(part.trace.power_w, (std::vector<double>{2, 3, 4}));
    EXPECT_EQ(run_of_recording(recording, {9.0, 0.5, 600.0}, 0.1).status, RunStatus::ended_early);
    EXPECT_EQ(run_of_recording(recording, {1.0, 9.0, 600.0}, 0.1).status, RunStatus::no_samples);
    EXPECT_DOUBLE_EQ(run_of_recording({{0.0}, {4.0}}, {}, 0.1).duration_s, 0.1);
}

/// A sampler runs next to components, and is started while they run.
TEST(SupervisedProcesses, EndNoOthers) {
    const auto component = test::new_marker();
    const auto sampler = test::new_marker();
    SupervisedProcesses of_component({{"sh", "-c", "setsid sleep " + component + " & sleep " + component}}, {});
    SupervisionOptions options;
    options.owns_orphans = false;
    SupervisedProcesses of_sampler({{"sleep", sampler}}, options);
    { const SupervisedProcesses before({{"sleep", sampler}}, options); }
    EXPECT_TRUE(test::wait_until([&] { return test::processes_with(component) >= 2; }));
    of_component.end();
    EXPECT_EQ(test::processes_with(component), 0);
    EXPECT_EQ(test::processes_with(sampler), 1);
}

/// What even SIGKILL of the profiler itself must not leave.
TEST(SupervisedProcesses, EndWithTheirOwner) {
    const auto marker = test::new_marker();
    const auto child = ::fork();
    if (child == 0) {
        SupervisedProcesses processes({{"sleep", marker}, {"sleep", marker}}, {});
        while (true) ::pause();
    }
    ASSERT_TRUE(test::wait_until([&] { return test::processes_with(marker) == 2; }));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(test::wait_until([&] { return test::processes_with(marker) == 0; }));
}

}  // namespace
}  // namespace flightwatt::compute
