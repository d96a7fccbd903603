// What the programs state of a log does not depend on the way it comes: as a log or as its series file; and what
// predict states of a moment does not depend on what the log wrote later.

#include "base/atomic_file.h"
#include "helpers/cut_logs.h"
#include "helpers/running_program.h"

#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

const std::vector<std::string> real_flights{"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"};

/// Every log of `logs`, and next to it its series file under another name.
struct BothWays {
    std::string logs;
    std::string series;
};

BothWays parse_all(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& folder) {
    BothWays ways;
    for (const auto& log : logs) {
        const auto series = folder / (log.stem().string() + "_renamed.csv");
        const auto parsed = test::run_shell(
            "flightwatt parse " + test::shell_quoted(log) + " -o " + test::shell_quoted(series), folder);
        EXPECT_EQ(parsed.code, 0) << parsed.err;
        ways.logs += " " + test::shell_quoted(log);
        ways.series += " " + test::shell_quoted(series);
    }
    return ways;
}

void expect_same(const std::string& command, const BothWays& ways, const std::filesystem::path& folder) {
    SCOPED_TRACE(command);
    const auto log = test::run_shell("flightwatt " + command + ways.logs, folder);
    const auto series = test::run_shell("flightwatt " + command + ways.series, folder);
    EXPECT_EQ(log.code, series.code) << log.err << series.err;
    EXPECT_EQ(log.out, series.out);
    EXPECT_FALSE(log.out.empty());
}

std::vector<std::filesystem::path> sample_logs() {
    std::vector<std::filesystem::path> logs;
    for (int i = 1; i <= 6; ++i) {
        logs.push_back(test::source_dir() / "logs" / fmt::format("opterra_synthetic_0{}.data", i));
    }
    return logs;
}

std::vector<std::filesystem::path> real_logs() {
    std::vector<std::filesystem::path> logs;
    for (const auto& name : real_flights) logs.push_back(test::shared_dir() / "flights" / (name + ".data"));
    return logs;
}

void expect_same_of_all(const std::vector<std::filesystem::path>& logs) {
    const auto folder = test::scratch_dir();
    const auto all = parse_all(logs, folder);
    expect_same("fit --name x --errors", all, folder);
    expect_same("validate", all, folder);
    expect_same("validate --at 300", all, folder);
    expect_same("battery --name x", all, folder);
    expect_same("battery --name x --correct-idle-offset", all, folder);
}

TEST(SameOnEveryWay, FitsTheSampleLogs) { expect_same_of_all(sample_logs()); }

TEST(SameOnEveryWayStudy, FitsTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    expect_same_of_all(real_logs());
    const auto folder = test::scratch_dir();
    const auto ways = parse_all(real_logs(), folder);
    const auto fit = test::run_shell("flightwatt fit --model-kind physical" + ways.series, folder);
    EXPECT_THAT(fit.out, HasSubstr("[physical]"));
}

TEST(SameOnEveryWay, SegmentsEveryLog) {
    const auto folder = test::scratch_dir();
    for (const auto& log : test::all_logs()) {
        const auto parsed = test::run_shell("flightwatt parse " + test::shell_quoted(log) + " -o a.csv", folder);
        if (parsed.code != 0) continue;  // it holds neither power nor altitude
        const BothWays ways{" " + test::shell_quoted(log), " a.csv"};
        if (const auto found = test::run_shell("flightwatt segment a.csv", folder); found.code != 0) {
            EXPECT_EQ(found.code, 3) << found.err;
            EXPECT_EQ(test::run_shell("flightwatt segment" + ways.logs, folder).code, 3) << "nothing flew";
            continue;
        }
        expect_same("segment", ways, folder);
        expect_same("segment --json --hold-time 20 --cruise-fraction 0.8", ways, folder);
        expect_same("segment --explain", ways, folder);
        expect_same("parse", ways, folder);
    }
}

/// Changes of what a log states after a moment.
std::vector<std::string> changed_after(const std::string& text, double moment_s) {
    const auto cut = test::cut_log(text, moment_s);
    std::vector<std::string> changed{cut.before};
    auto shuffled = cut.after;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
    std::string all = cut.before;
    for (const auto& line : shuffled) all += line;
    changed.push_back(all);
    all = cut.before;
    for (auto line : cut.after) {  // every number of every message is another
        const auto fields = line.find(' ', line.find(' ', line.find(' ') + 1) + 1);
        for (std::size_t i = fields; i < line.size(); ++i) {
            if (line[i] >= '0' && line[i] <= '8') line[i] = static_cast<char>(line[i] + 1);
        }
        all += line;
    }
    changed.push_back(all);
    all = cut.before;
    for (const auto& line : cut.after) all += "rubbish\n" + line.substr(0, line.size() / 2) + "\n";
    changed.push_back(all + "99 ");
    all = cut.before;
    for (const auto& line : cut.after) all += line.substr(0, line.find(' ')) + " 99" + line.substr(line.find(' '));
    changed.push_back(all);  // another aircraft speaks
    return changed;
}

void expect_no_hindsight(const std::filesystem::path& log, const std::string& options, const std::string& moment) {
    SCOPED_TRACE(log.string() + " " + moment);
    const auto folder = test::scratch_dir();
    const auto command = "flightwatt predict flight.data " + options + " " + moment;
    const auto put = [&](const std::string& text) { write_file_atomically(folder / "flight.data", text); };
    const auto text = telemetry::read_data_file(log);
    std::filesystem::copy_file(telemetry::find_log_file(log).value(), folder / "flight.log");
    put(text);
    const auto whole = test::run_shell(command, folder);
    ASSERT_EQ(whole.code, 0) << whole.err;
    const auto json = test::run_shell(command + " --json", folder).out;
    const auto at = json.find("\"until_s\": ") + 11;
    const double moment_s = number_or_nan(json.substr(at, json.find(',', at) - at));
    ASSERT_GT(moment_s, 0.0);
    for (const auto& changed : changed_after(text, moment_s)) {
        put(changed);
        const auto other = test::run_shell(command, folder);
        EXPECT_EQ(other.code, whole.code);
        EXPECT_EQ(other.out, whole.out);
        EXPECT_EQ(other.err, whole.err);
    }
}

TEST(NoHindsight, PredictsTheSameWhateverTheLogSaysLater) {
    const auto folder = test::scratch_dir();
    std::string logs;
    for (const auto& log : sample_logs()) logs += " " + test::shell_quoted(log);
    const auto model = folder.parent_path() / "no_hindsight_model.toml";
    const auto fit = test::run_shell(fmt::format("flightwatt fit {} -o {}", logs, test::shell_quoted(model)), folder);
    ASSERT_EQ(fit.code, 0) << fit.err;
    const auto options = "--remaining 200 --model " + test::shell_quoted(model);
    expect_no_hindsight(sample_logs()[0], options, "--at-log-time 134.499");
    expect_no_hindsight(sample_logs()[0], options, "--at 120");
    expect_no_hindsight(sample_logs()[2], options, "--at 300");
}

TEST(NoHindsight, PredictsTheSameOfTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    std::string logs;
    for (const auto& log : real_logs()) logs += " " + test::shell_quoted(log);
    const auto model = folder.parent_path() / "no_hindsight_real.toml";
    const auto fit = test::run_shell(
        fmt::format("flightwatt fit --model-kind physical {} -o {}", logs, test::shell_quoted(model)), folder);
    ASSERT_EQ(fit.code, 0) << fit.err;
    const auto options = "--airspeed 13 --remaining 300 --model " + test::shell_quoted(model);
    for (const auto& log : real_logs()) {
        expect_no_hindsight(log, options, "--at 300");
    }
}

}  // namespace
}  // namespace flightwatt::cli
