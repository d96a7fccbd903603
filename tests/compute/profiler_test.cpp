// The profiler from specification to files, through the program.

#include "compute/profiler.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/number.h"
#include "compute/powprofiler/powprofiler.h"
#include "compute/profile_reader.h"
#include "compute/profile_tables.h"
#include "compute/profiling/profile_runs.h"
#include "compute/sensors/power_trace.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using testing::HasSubstr;
using testing::Not;

class Profiler : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    int profile(const std::string& spec, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{spec, "-o", "out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run_program("flightwatt-profile", arguments, folder);
    }
    void write(const std::string& name, const std::string& text) const {
        make_directories((folder / name).parent_path());
        test::write_text(folder / name, text);
    }
    std::string text(const std::string& name) const { return read_file(folder / name); }
    CsvTable table(const std::string& name) const { return read_csv(folder / name); }
    double cell(const CsvTable& table, std::size_t row, const std::string& column) const {
        return cell_number(table, table.rows.at(row), column_index(table, column));
    }
};

/// A meter that shows 2 W, or what a component writes into a file named `busy`. A busy machine needs its time to start
/// either: powers of a component that does are compared in the study alone.
constexpr const char* meter =
    "idle_s = 1\nduration_s = 1\n[sampler]\ninterval_s = 0.02\n"
    "command = ['sh', '-c', 'while :; do cat busy 2>/dev/null || echo 2; sleep 0.02; done']\n";

class ProfilerStudy : public Profiler {};

TEST_F(ProfilerStudy, WritesLayersThatMissionsRead) {
    write("p.toml", std::string(meter) +
                        "repeats = 2\n"
                        "[components.load]\ncommand = ['sh', '-c', 'trap \"rm -f busy; exit\" TERM; echo {w} > busy; "
                        "while :; do sleep 0.01; done']\nwarm_up_s = 2\nqos = { w = [3, 5] }\n");
    // TOML's tables end with the next: `repeats` belongs above them.
    auto spec = text("p.toml");
    spec.erase(spec.find("repeats = 2\n"), 12);
    write("p.toml", "repeats = 2\nabove_idle = true\n" + spec);
    ASSERT_EQ(profile("p.toml"), 0) << text("stderr");
    const auto layer2 = table("out/load.csv");
    ASSERT_EQ(layer2.rows.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const double total_w = i == 0 ? 3.0 : 5.0;
        EXPECT_NEAR(cell(layer2, i, "total_power_w"), total_w, 1e-6);
        EXPECT_NEAR(cell(layer2, i, "power_w"), total_w - 2.0, 1e-6);
        EXPECT_NEAR(cell(layer2, i, "duration_s"), 1.0, 1e-6);
        EXPECT_NEAR(cell(layer2, i, "energy_j"), cell(layer2, i, "power_w") * cell(layer2, i, "duration_s"), 1e-5);
        EXPECT_EQ(cell(layer2, i, "repeats"), 2.0);
    }
    EXPECT_DOUBLE_EQ(power_w(read_power_profile(folder / "out/load.csv"), {4.0}), 2.0);
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/idle.csv"), {}), 2.0, 1e-9);
    EXPECT_THAT(text("out/load.csv"), HasSubstr("# power_w is the power above that of the idle computer, 2 W"));
    const auto samples = read_power_trace(folder / "out/layer1/load/w=5_repeat_2.csv", std::nullopt);
    EXPECT_GE(samples.time_s.front(), 2.0);
    EXPECT_EQ(samples.power_w.front(), 5.0);
    EXPECT_EQ(test::processes_with(folder.string()), 0);
}

/// A worker that leaves its component's session does not add its power to later runs.
TEST_F(ProfilerStudy, MeasuresEachComponentAlone) {
    write("p.toml", std::string(meter) +
                        "[components.a]\ncommand = ['sh', '-c', \"setsid sh -c 'trap \\\"rm -f busy; exit\\\" "
                        "TERM; while :; do echo 50 > busy; sleep 0.01; done' & sleep 60\"]\nwarm_up_s = 2\n"
                        "[components.b]\ncommand = ['sleep', '60']\n");
    ASSERT_EQ(profile("p.toml"), 0) << text("stderr");
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/a.csv"), {}), 50.0, 1.0);
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/b.csv"), {}), 2.0, 1e-9);
}

TEST_F(Profiler, GoesOnPastThoseThatFail) {
    const auto marker = test::new_marker();
    // A slow machine may start what crashes late.
    auto patient_meter = std::string(meter);
    patient_meter.replace(patient_meter.find("duration_s = 1"), 14, "duration_s = 4");
    write("p.toml", patient_meter + "[components.crash]\ncommand = ['sh', '-c', 'sleep " + marker +
                        " & echo sorry >&2; exit 3']\n[components.hang]\ncommand = ['sleep', '" + marker +
                        "']\n[components.good]\ncommand = ['sleep', '" + marker + "']\n");
    EXPECT_EQ(profile("p.toml"), 4);
    EXPECT_THAT(text("out/runs.csv"), HasSubstr("crash,,1,failed,\"exit code 3; left processes behind, ended\""));
    EXPECT_EQ(text("out/layer1/crash/repeat_1.txt"), "sorry\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "out/crash.csv"));
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/good.csv"), {}), 2.0, 1e-9);
    EXPECT_EQ(test::processes_with(marker), 0);
}

TEST_F(Profiler, StartsProgramsFromTheFolderOfTheSpecification) {
    std::filesystem::create_directories(folder / "spec");
    write("spec/watts.sh", "#!/bin/sh\nwhile :; do echo 2; sleep 0.02; done\n");
    write("spec/load.sh", "#!/bin/sh\nsleep 60\n");
    for (const auto* name : {"spec/watts.sh", "spec/load.sh"})
        std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
    write("spec/p.toml",
          "idle_s = 0\nduration_s = 1\n[sampler]\ninterval_s = 0.02\ncommand = ['./watts.sh']\n"
          "[components.load]\ncommand = ['./load.sh']\n");
    EXPECT_EQ(profile("spec/p.toml"), 0) << text("stderr");
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/load.csv"), {}), 2.0, 1e-9);
}

TEST_F(Profiler, ReplacesResultsOfAProfileAlone) {
    write("p.toml", std::string(meter) + "[components.good]\ncommand = ['sleep', '60']\n");
    for (const auto* name : {"out/good.csv", "out/idle.csv", "out/runs.csv"}) {
        std::filesystem::create_directories(folder / "out");
        write(name, "mine\n");
        EXPECT_EQ(profile("p.toml"), 2) << name;
        EXPECT_THAT(text("stderr"), HasSubstr(std::string(name) + " exists and is not of a profile"));
        EXPECT_EQ(text(name), "mine\n");
        std::filesystem::remove(folder / name);
    }
    EXPECT_EQ(profile("p.toml"), 0);
    EXPECT_EQ(profile("p.toml"), 0);
}

TEST_F(Profiler, CtrlCLeavesNothingAndIsResumed) {
    const auto marker = test::new_marker();
    // Each start leaves a line in `starts`; the third configuration hangs until it is interrupted.
    write("p.toml", std::string(meter) + "[components.a]\ncommand = ['sh', '-c', 'echo {n} >> starts; sleep " + marker +
                        " & [ -e free ] || [ $(wc -l < starts) -lt 3 ] || sleep " + marker +
                        "; sleep 0.5']\nqos = { n = [1, 2, 3, 4] }\n");
    auto spec = text("p.toml");
    spec.replace(spec.find("duration_s = 1\n"), 15, "timeout_s = 120\n");
    write("p.toml", spec);
    const auto child = test::start_program("flightwatt-profile", {"p.toml", "-o", "out"}, folder);
    const auto lines = [&] {
        std::ifstream file(folder / "starts");
        return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    };
    ASSERT_TRUE(test::wait_until([&] { return lines() == 3; }));
    ASSERT_TRUE(test::wait_until([&] { return test::processes_with(marker) >= 3; }));
    ::kill(child, SIGINT);
    EXPECT_EQ(test::exit_code_of(child), 130);
    EXPECT_EQ(test::processes_with(marker), 0);
    EXPECT_THAT(text("stderr"),
                HasSubstr("stopped by SIGINT after 3 of 5 runs; the same command continues from there"));
    const auto before = text("starts");
    const auto idle = text("out/layer1/idle/repeat_1.csv");
    write("free", "");
    ASSERT_EQ(profile("p.toml"), 0) << text("stderr");
    EXPECT_EQ(lines(), 5);  // the interrupted one again, and the one that was to come
    EXPECT_THAT(text("stderr"), HasSubstr("[3/5] a n="));
    EXPECT_EQ(text("out/layer1/idle/repeat_1.csv"), idle);
    EXPECT_EQ(table("out/a.csv").rows.size(), 4U);
    // A configuration that has changed is done again, the others are not.
    spec.replace(spec.find("[1, 2, 3, 4]"), 12, "[1, 2, 3, 5]");
    write("p.toml", spec);
    ASSERT_EQ(profile("p.toml"), 0);
    EXPECT_EQ(lines(), 6);
    EXPECT_EQ(test::processes_with(marker), 0);
}

/// A component that burns a random share of the processor and keeps account of it, and a meter of 5 W plus
/// 10 W times the share that the kernel states it got. It needs a processor of its own: a busy machine gives it too few
/// slots to compare.
TEST_F(ProfilerStudy, IsWithinItsStandardErrorOfALoadThatIsKnown) {
    write("load.py", R"(
import os, random, sys, time
share = float(sys.argv[1])
with open("pid.new", "w") as file: file.write(str(os.getpid()))
os.rename("pid.new", "pid")
random.seed(share)
account = open("account." + sys.argv[1], "w")
while True:
    begin, used, burn = time.monotonic(), time.process_time(), random.uniform(0, 2 * share) * 0.04
    account.write(f"{begin} {used}\n"); account.flush()
    while time.process_time() - used < burn and time.monotonic() - begin < 0.2: pass
    time.sleep(max(0.0, begin + 0.04 - time.monotonic()))
)");
    write("meter.py", R"(
import time
last = None
while True:
    try:
        pid = open("pid").read()
        now = (pid, time.monotonic(), int(open(f"/proc/{pid}/schedstat").read().split()[0]) / 1e9)
    except (OSError, ValueError):
        now = None
    share = (now[2] - last[2]) / (now[1] - last[1]) if now and last and now[0] == last[0] else 0.0
    print(5.0 + 10.0 * share, flush=True)
    last = now
    time.sleep(0.02)
)");
    write("p.toml",
          "idle_s = 1\nduration_s = 4\nwarm_up_s = 2\n[sampler]\ncommand = ['python3', 'meter.py']\n"
          "[components.load]\ncommand = ['python3', 'load.py', '{share}']\nqos = { share = [0.15, 0.4] }\n");
    ASSERT_EQ(profile("p.toml"), 0) << text("stderr");
    const auto layer2 = table("out/load.csv");
    for (std::size_t i = 0; i < layer2.rows.size(); ++i) {
        const auto share = layer2.rows[i].cells[0].text;
        const auto samples = read_power_trace(folder / ("out/layer1/load/share=" + share + "_repeat_1.csv"), {});
        // Its own account over the same time from its start on.
        std::ifstream account(folder / ("account." + share));
        std::vector<std::pair<double, double>> used;
        for (double time = 0.0, cpu = 0.0; account >> time >> cpu;) used.emplace_back(time, cpu);
        ASSERT_GT(used.size(), 10U);
        // Its clock starts when Python has; its last line is of the slot in which it was ended.
        const auto start = std::pair(used.front().first + samples.time_s.front(), 0.0);
        const auto first = *std::lower_bound(used.begin(), used.end() - 1, start);
        const auto last = used.back();
        const double truth_w = 5.0 + 10.0 * (last.second - first.second) / (last.first - first.first);
        const double power = cell(layer2, i, "power_w");
        const double error = cell(layer2, i, "standard_error_w");
        std::cout << "share " << share << ": truth " << truth_w << " W, profiled " << power << " +- " << error
                  << " W\n";
        EXPECT_NEAR(power, truth_w, 5.0 * error);
        EXPECT_GT(error, 0.01);
        EXPECT_LT(error, 2.0);
        EXPECT_GT(power, 5.0 + error);  // it really loads this machine
    }
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/idle.csv"), {}), 5.0, 1e-9);
}

TEST_F(Profiler, ReadsAJetsonTree) {
    write("tree/sys/bus/i2c/drivers/ina3221x/6-0040/iio:device0/rail_name_0", "POM_5V_IN\n");
    write("tree/sys/bus/i2c/drivers/ina3221x/6-0040/iio:device0/in_power0_input", "2545\n");
    write("p.toml",
          "idle_s = 0.1\nduration_s = 0.2\n[sampler]\ninterval_s = 0.02\nsysfs = 'tree/sys'\n"
          "[components.a]\ncommand = ['sleep', '60']\n");
    ASSERT_EQ(profile("p.toml"), 0) << text("stderr");
    EXPECT_THAT(text("stderr"), HasSubstr("sampling with ina3221: POM_5V_IN (tree/sys/bus/i2c/"));
    EXPECT_NEAR(power_w(read_power_profile(folder / "out/a.csv"), {}), 2.545, 1e-9);
}

TEST_F(Profiler, TakesPowprofilersRecordingsWithoutItsEnergyError) {
    write("m2l-1.csv", "100,101,102\n4,1,1\n6,1,1\n5,1,1\n");
    write("m2l-2.csv", "100,101,102\n8,1,1\n8,1,1\n");
    write("p.toml",
          "[sampler]\ninterval_s = 0.1\nfile = '{component}-{fps}.csv'\n[components.m2l]\nqos = { fps = [1, 2] }\n");
    ASSERT_EQ(profile("p.toml", {}), 0) << text("stderr");
    // At 10 Hz: 0.3 s of 5 W and 0.2 s of 8 W; powprofiler writes the sums of samples, 15 and 16.
    const auto layer2 = table("out/m2l.csv");
    EXPECT_NEAR(cell(layer2, 0, "energy_j"), 1.5, 1e-6);
    EXPECT_NEAR(cell(layer2, 1, "energy_j"), 1.6, 1e-6);
    EXPECT_DOUBLE_EQ(power_w(read_power_profile(folder / "out/m2l.csv"), {1.5}), 6.5);
}

TEST(PlannedRuns, AreShuffledRepeatByRepeatByTheSeed) {
    ProfileSpecification spec;
    spec.components.push_back({"a", {"n"}, {}, {}});
    for (int n = 0; n < 8; ++n) spec.components[0].configurations.push_back({{n * 1.0}, {{"a"}}, {}});
    spec.repeats = 3;
    const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7};
    const auto order = [&] {
        std::vector<std::size_t> nodes;
        for (const auto& run : planned_runs(spec)) nodes.push_back(run.node);
        return nodes;
    };
    const auto first = order();
    ASSERT_EQ(first.size(), 25U);  // idle first
    EXPECT_EQ(planned_runs(spec).front().component, idle_component);
    EXPECT_EQ(order(), first);
    const std::vector<std::size_t> one(first.begin() + 1, first.begin() + 9);
    EXPECT_THAT(one, testing::UnorderedElementsAreArray(all));
    EXPECT_THAT(one, Not(testing::ElementsAreArray(all)));
    spec.seed = 2;
    EXPECT_NE(order(), first);
}

}  // namespace
}  // namespace flightwatt::compute
