// The options of reading flights are the same on every stage that reads them, and reach it.

#include "cli/output/flight_options.h"

#include "base/atomic_file.h"
#include "helpers/cut_logs.h"
#include "helpers/running_program.h"
#include "helpers/sample_logs.h"

#include <boost/algorithm/string/replace.hpp>
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
        EXPECT_THAT(twice.err,
                    HasSubstr("warning: first: it is not used: it is the same flight as opterra_synthetic_01"));
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

/// A flight of a CSV without an aircraft.
std::string plain_flight(double voltage_v, double power_w) {
    std::string csv = "time_s,power_w,altitude_m,throttle_percent,voltage_v,current_a\n";
    for (int t = 0; t < 600; ++t) {
        const bool flies = t > 100 && t < 500;
        const double height = flies ? std::min({100.0, 4.0 * (t - 100), 4.0 * (500 - t)}) : 0.0;
        const double power = flies ? power_w + t % 7 : 1.0;
        const double voltage = voltage_v - 0.001 * t - (flies ? 0.2 : 0.0);
        csv += fmt::format("{},{},{},{},{:.3f},{:.4f}\n", t, power, height, flies ? 60 : 0, voltage, power / voltage);
    }
    return csv;
}

TEST_F(FlightOptions, KnowAircraftWithoutIdsByTheirPacks) {
    write_file_atomically(folder_ / "copter.csv", plain_flight(24.8, 400.0));
    write_file_atomically(folder_ / "wing.csv", plain_flight(12.4, 300.0));
    for (const auto* stage : {"fit --order 0", "validate --order 0", "battery", "trends"}) {
        const auto both = run(std::string(stage) + " copter.csv wing.csv");
        EXPECT_EQ(both.code, input_rejected) << stage;
        EXPECT_THAT(both.err, HasSubstr("aircraft  name  kind"));
        EXPECT_THAT(both.err, HasSubstr("6 to 7"));
        EXPECT_THAT(both.err, HasSubstr("the flights are of 2 aircraft; choose one with --aircraft"));
        const auto command =
            fmt::format("for one of them:  flightwatt {} copter.csv wing.csv --aircraft copter\n", stage);
        EXPECT_THAT(both.err, HasSubstr(command));
    }
    const auto one = run("fit --order 0 copter.csv wing.csv --aircraft copter");
    EXPECT_EQ(one.code, ok) << one.err;
    EXPECT_THAT(one.err, HasSubstr("not used, as of other aircraft: wing"));
    EXPECT_EQ(one.out, run("fit --order 0 copter.csv").out);
    EXPECT_EQ(run("fit --order 0 copter.csv wing.csv --mix-aircraft").code, ok);
    const auto none = run("fit --order 0 copter.csv wing.csv --aircraft boat");
    EXPECT_EQ(none.code, usage_error);
    EXPECT_THAT(none.err,
                HasSubstr("--aircraft boat: there is no such aircraft; there are: unknown: copter; unknown: wing"));
}

TEST_F(FlightOptions, ChooseTheAircraftOfManyLogs) {
    const auto three = sample(1) + sample(2) + " other.data";
    const auto log = test::source_dir() / "logs" / "opterra_synthetic_03.data";
    auto data = telemetry::read_data_file(log);
    boost::algorithm::replace_all(data, " 7 ", " 8 ");
    write_file_atomically(folder_ / "other.data", data);
    auto definitions = read_file(telemetry::find_log_file(log).value());
    boost::algorithm::replace_all(definitions, "ac_id=\"7\"", "ac_id=\"8\"");
    boost::algorithm::replace_all(definitions, "Opterra_synthetic", "Twinstar_synthetic");
    write_file_atomically(folder_ / "other.log", definitions);
    const auto expected = run("fit --order 1 other.data").out;
    const auto phases = run("segment other.data").out;
    for (const auto* text : {"8", "Twinstar_synthetic", "other"}) {
        const auto aircraft = fmt::format(" --aircraft {}", text);
        EXPECT_EQ(run("fit --order 1" + three + aircraft).out, expected) << text;
        EXPECT_EQ(run("segment other.data" + aircraft).out, phases) << text;
        EXPECT_THAT(run("segment" + three + aircraft).out, HasSubstr("\nother,1,cruise,")) << text;
        EXPECT_THAT(run("segment" + three + aircraft).out, testing::Not(HasSubstr("opterra_synthetic_01"))) << text;
        EXPECT_EQ(run("batch --order 1 -o out" + three + aircraft).code, ok) << text;
        EXPECT_EQ(run("fit --order 1 out --name fitted").out, expected) << "the batch left out the others";
    }
    EXPECT_EQ(run("fit --order 1 out --name fitted --aircraft 7").out,
              run("fit --order 1" + sample(1) + sample(2)).out);
    EXPECT_EQ(run("validate out --aircraft 9").code, usage_error);
}

TEST_F(FlightOptions, MakeAResultOfEachAircraft) {
    write_file_atomically(folder_ / "copter.csv", plain_flight(24.8, 400.0));
    write_file_atomically(folder_ / "wing.csv", plain_flight(12.4, 300.0));
    EXPECT_EQ(run("fit --order 0 --each copter.csv wing.csv -o models").code, ok);
    EXPECT_EQ(run("batch --order 0 --each copter.csv wing.csv -o out").code, ok);
    for (const std::string flight : {"copter", "wing"}) {
        ASSERT_EQ(run("batch --order 0 -o alone_" + flight + " " + flight + ".csv").code, ok);
        for (const auto* file : {"model.toml", "flights.csv", "table1.txt"})
            EXPECT_EQ(read_file(folder_ / "out" / flight / file), read_file(folder_ / ("alone_" + flight) / file));
        EXPECT_TRUE(std::filesystem::exists(folder_ / "models" / flight / "model.toml"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "model.toml"));
    EXPECT_THAT(run("batch --order 0 --each copter.csv wing.csv -o json --json").out,
                HasSubstr("\"folder\": \"json/wing\""));
    EXPECT_EQ(run("fit --each copter.csv").code, usage_error) << "no file for the models";
    EXPECT_EQ(run("fit --each copter.csv -o m.toml --aircraft copter").code, usage_error);
}

TEST_F(FlightOptions, LeaveNoModelOfAnAircraftWithoutFlightsInAFolderOfEach) {
    write_file_atomically(folder_ / "copter.csv", plain_flight(24.8, 400.0));
    write_file_atomically(folder_ / "wing.csv", plain_flight(12.4, 300.0));
    ASSERT_EQ(run("batch --order 0 --each copter.csv wing.csv -o out").code, ok);
    ASSERT_EQ(run("batch --order 0 wing.csv -o out/own").code, ok);
    write_file_atomically(folder_ / "out" / "wing" / "mine.txt", "of the user");
    const auto kept = run("batch --order 0 --each copter.csv -o out");
    EXPECT_THAT(kept.err, testing::Not(HasSubstr("earlier run's: no flight"))) << "its flight stays";
    const auto pruned = run("batch --order 0 --each --prune copter.csv -o out");
    EXPECT_EQ(pruned.code, ok) << pruned.err;
    EXPECT_THAT(pruned.err, HasSubstr("removed: out/wing, of an earlier run"));
    for (const auto* file : {"batch.json", "model.toml", "flights.csv", "flights"})
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "wing" / file)) << file;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "wing" / "mine.txt"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "copter" / "model.toml"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "own" / "model.toml")) << "a batch of the user's";
}

TEST_F(FlightOptions, WarnOfAModelOfAnAircraftWithoutFlightsInAFolderOfEach) {
    write_file_atomically(folder_ / "copter.csv", plain_flight(24.8, 400.0));
    write_file_atomically(folder_ / "wing.csv", plain_flight(12.4, 300.0));
    ASSERT_EQ(run("batch --order 0 --each copter.csv wing.csv -o out").code, ok);
    const auto excluded = run("batch --order 0 --each copter.csv wing.csv -o out --exclude wing");
    EXPECT_THAT(excluded.err, HasSubstr("warning: out/wing and its model are an earlier run's"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "wing" / "model.toml"));
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
    EXPECT_THAT(batch.err, HasSubstr("opterra_synthetic_02: it is not used in the fit: --exclude names it"));
    for (const auto* stage : {"fit", "validate", "battery", "batch -o out"}) {
        const auto unknown = run(stage + three + " --exclude opterra_synthetic_2");
        EXPECT_EQ(unknown.code, usage_error) << stage;
        EXPECT_THAT(unknown.err, HasSubstr("there is no such flight; did you mean 'opterra_synthetic_02'?"));
        EXPECT_EQ(run(stage + three + " --keep unknown").code, usage_error) << stage;
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
    // Autopilots number their logs: those of two cards have the same names.
    for (const int number : {1, 2}) test::copy_sample(number, folder_ / fmt::format("card{}", number), "00000001");
    const auto apart = run("fit --name x card1 card2");
    EXPECT_EQ(apart.code, usage_error);
    EXPECT_THAT(apart.err, HasSubstr("flight '00000001' is given twice, by card1"));
    EXPECT_THAT(apart.err, HasSubstr("'flightwatt batch' of the logs takes equal names apart"));
}

}  // namespace
}  // namespace flightwatt::cli
