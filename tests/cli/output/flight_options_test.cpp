// The options of reading flights are the same on every stage that reads them, and reach it.

#include "cli/output/flight_options.h"

#include "base/atomic_file.h"
#include "helpers/cut_logs.h"
#include "helpers/running_program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

class FlightOptions : public testing::Test {
  protected:
    test::ProgramResult run(const std::string& command) { return test::run_shell("flightwatt " + command, folder_); }
    /// The same command with and without an option; what they print must differ.
    void expect_effect(const std::string& command, const std::string& option) {
        SCOPED_TRACE(command + " " + option);
        const auto without = run(command);
        const auto with = run(command + " " + option);
        EXPECT_EQ(without.code, 0) << without.err;
        EXPECT_EQ(with.code, 0) << with.err;
        EXPECT_NE(with.out, without.out);
    }
    static std::string sample(int number) {
        return " " +
               test::shell_quoted(test::source_dir() / "logs" / fmt::format("opterra_synthetic_0{}.data", number));
    }
    static std::string two_sorties() {
        for (const auto& log : test::all_logs()) {
            if (log.filename() == "hazard_01_two-sorties.data") return " " + test::shell_quoted(log);
        }
        return " hazard_01_two-sorties.data";
    }
    std::string model() {
        const auto file = folder_ / "model.toml";
        EXPECT_EQ(run("fit" + sample(1) + sample(2) + sample(3) + " -o model.toml").code, 0);
        return " --model " + test::shell_quoted(file);
    }
    /// Two aircraft in one log, of which both fly.
    void write_two_aircraft() {
        const auto log = test::source_dir() / "logs" / "opterra_synthetic_01.data";
        const auto text = telemetry::read_data_file(log);
        std::string other;
        for (auto line : test::lines_of(text)) {
            if (const auto at = line.find(" 7 "); at != std::string::npos) line.replace(at, 3, " 8 ");
            other += line;
        }
        write_file_atomically(folder_ / "two.data", text + other);
        std::filesystem::copy_file(telemetry::find_log_file(log).value(), folder_ / "two.log");
    }
    std::filesystem::path folder_ = test::scratch_dir();
};

/// The copy that is used need not be the first.
TEST_F(FlightOptions, UseTheRecordingOfAFlightThatHasItsLog) {
    const auto log = test::source_dir() / "logs" / "opterra_synthetic_01.data";
    std::filesystem::copy_file(log, folder_ / "first.data");
    for (const std::string stage : {"fit --order 1", "validate --order 1", "battery"}) {
        const auto once = run(stage + sample(1) + sample(2) + sample(3));
        const auto twice = run(stage + " first.data" + sample(1) + sample(2) + sample(3));
        EXPECT_EQ(twice.code, 0) << twice.err;
        EXPECT_THAT(twice.err, HasSubstr("warning: first is excluded: it is the same flight as opterra_synthetic_01"));
        EXPECT_EQ(twice.out, once.out) << stage;
    }
}

TEST_F(FlightOptions, OfSegmentationReachEveryStage) {
    const std::vector<std::string> options{"--cruise-fraction 0.7", "--ground-fraction 0.1", "--hold-time 3"};
    for (const auto& option : options) {
        expect_effect("segment" + sample(1), option);
        expect_effect("fit" + sample(1) + sample(2), option);
        expect_effect("validate" + sample(1) + sample(2), option);
    }
    expect_effect("segment" + sample(1) + " --json", "--rest-time 60");
    expect_effect("segment" + sample(1) + " --json", "--idle-throttle 60");
    expect_effect("predict --at 200 --remaining 100" + model() + sample(4), "--cruise-fraction 0.6");
    const auto high = run("fit --flight-height 5000" + sample(1));
    EXPECT_EQ(high.code, input_rejected);
    EXPECT_THAT(high.err, HasSubstr("has no flight"));
    EXPECT_EQ(run("battery --flight-height 5000 --name x" + sample(1)).code, ok);
    EXPECT_EQ(run("parse --hold-time 0" + sample(1)).code, usage_error);
    EXPECT_EQ(run("batch -o out" + sample(1)).code, ok);
    const auto once = read_file(folder_ / "out" / "model.toml");
    EXPECT_EQ(run("batch -o out --cruise-fraction 0.7" + sample(1)).code, ok);
    EXPECT_NE(read_file(folder_ / "out" / "model.toml"), once);
}

TEST_F(FlightOptions, ChooseTheAircraft) {
    write_two_aircraft();
    for (const auto* stage : {"parse", "segment", "fit --name x", "battery --name x"}) {
        const auto refused = run(std::string(stage) + " two.data");
        EXPECT_EQ(refused.code, input_rejected) << stage;
        EXPECT_THAT(refused.err, HasSubstr("several aircraft flew: 7, 8; select one with --aircraft ID"));
        EXPECT_EQ(run(std::string(stage) + " two.data --aircraft 8").code, ok) << stage;
    }
    const auto predict = "predict two.data --at 200 --remaining 100" + model();
    EXPECT_EQ(run(predict).code, input_rejected);
    EXPECT_EQ(run(predict + " --aircraft 7").code, ok);
    const auto other = run("segment two.data --aircraft 9");
    EXPECT_THAT(other.err, HasSubstr("aircraft 9 sent nothing"));
    ASSERT_EQ(run("parse two.data --aircraft 8 -o eight.csv").code, ok);
    EXPECT_EQ(run("segment eight.csv --aircraft 8").code, ok);
    EXPECT_THAT(run("segment eight.csv --aircraft 7").err, HasSubstr("aircraft 7 sent nothing"));
}

TEST_F(FlightOptions, ChooseTheSortie) {
    expect_effect("segment" + two_sorties(), "--sortie 2");
    const auto second = run("segment --sortie 2" + two_sorties());
    EXPECT_THAT(second.out, HasSubstr("\n2,takeoff,"));
    EXPECT_THAT(second.out, testing::Not(HasSubstr("\n1,takeoff,")));
    expect_effect("fit --name x --keep hazard_01_two-sorties" + two_sorties(), "--sortie 2");
    const auto third = run("fit --sortie 3" + two_sorties());
    EXPECT_EQ(third.code, input_rejected);
    EXPECT_THAT(third.err, HasSubstr("has no sortie 3: there are 2"));
    EXPECT_EQ(run("segment --sortie 0" + two_sorties()).code, usage_error);
}

TEST_F(FlightOptions, CorrectTheIdleOffset) {
    for (const auto* stage : {"parse", "segment", "fit --name x", "battery --name x"}) {
        expect_effect(stage + sample(1), "--correct-idle-offset");
    }
    expect_effect("validate" + sample(1) + sample(2), "--correct-idle-offset");
    expect_effect("predict --at 200 --remaining 100" + model() + sample(4), "--correct-idle-offset");
}

TEST_F(FlightOptions, ExcludeAndKeepFlights) {
    const auto three = sample(1) + sample(2) + sample(3);
    expect_effect("fit --name x" + three, "--exclude opterra_synthetic_02");
    expect_effect("validate" + three, "--exclude opterra_synthetic_02");
    expect_effect("battery --name x" + three, "--exclude opterra_synthetic_02");
    const auto batch = run("batch -o out --exclude opterra_synthetic_02" + three);
    EXPECT_THAT(batch.err, HasSubstr("opterra_synthetic_02: it is excluded from the fit: --exclude names it"));
    for (const auto* stage : {"fit", "validate", "battery", "batch -o out"}) {
        const auto unknown = run(stage + three + " --exclude opterra_synthetic_2");
        EXPECT_EQ(unknown.code, usage_error) << stage;
        EXPECT_THAT(unknown.err, HasSubstr("there is no such flight; did you mean 'opterra_synthetic_02'?"));
        EXPECT_EQ(run(stage + three + " --keep nobody").code, usage_error) << stage;
    }
    EXPECT_EQ(run("segment --exclude opterra_synthetic_01" + sample(1)).code, usage_error);
    // Power that runs the wrong way is refused, unless it is kept.
    std::string csv = run("parse" + sample(1)).out;
    write_file_atomically(folder_ / "a.csv", csv);
    ASSERT_EQ(run("segment a.csv --json").code, ok);
    std::string plain = "time_s,power_w,altitude_m,throttle_percent\n";
    for (int t = 0; t < 600; ++t) {
        const bool flies = t > 100 && t < 500;
        const double height = flies ? std::min({100.0, 4.0 * (t - 100), 4.0 * (500 - t)}) : 0.0;
        plain += fmt::format("{},{},{},{}\n", t, -20 - t % 7, height, flies ? 60 : 0);
    }
    write_file_atomically(folder_ / "negative.csv", plain);
    const auto refused = run("fit --name x negative.csv");
    EXPECT_NE(refused.code, ok);
    EXPECT_THAT(refused.err, HasSubstr("power is negative on average in flight"));
    EXPECT_EQ(run("fit --name x negative.csv --keep negative").code, ok);
}

TEST_F(FlightOptions, AreGivenOnceAndRefuseAFlightThatIsGivenTwice) {
    for (const auto* stage : {"fit", "validate", "battery"}) {
        const auto twice = run(stage + sample(1) + sample(1));
        EXPECT_EQ(twice.code, usage_error) << stage;
        EXPECT_THAT(twice.err, HasSubstr("flight 'opterra_synthetic_01' is given twice"));
    }
}

}  // namespace
}  // namespace flightwatt::cli
