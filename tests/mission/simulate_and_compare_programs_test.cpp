// flightwatt-simulate and flightwatt-compare as a user runs them.

#include "base/atomic_file.h"
#include "base/csv.h"
#include "helpers/rejected.h"
#include "helpers/running_program.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::mission {
namespace {

using test::write_text;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// Runs a program of ours in the test's own folder.
test::ProgramResult run(const std::filesystem::path& folder, const std::string& program, const std::string& arguments) {
    return test::run_shell("flightwatt-" + program + " " + arguments, folder);
}

/// A computing mission of an hour at 25 W.
void write_mission(const std::filesystem::path& folder, const std::string& name, const std::string& battery) {
    write_text(folder / "load.csv", "power_w\n25\n");
    write_text(folder / (name + ".toml"),
               "mechanical = \"none\"\nduration_s = { takeoff = 0, cruise = 3600, landing = 0 }\n"
               "battery = { " +
                   battery +
                   " }\n[components.load]\nprofile = \"load.csv\"\n"
                   "[[schedule]]\notherwise = true\nrun = { load = {} }\n");
}

const std::string lasting = "voltage_v = 10, resistance_ohm = 0, capacity_ah = 10";
const std::string small = "voltage_v = 10, resistance_ohm = 0, capacity_ah = 2";
const std::string smaller = "voltage_v = 10, resistance_ohm = 0, capacity_ah = 1";
const std::string weak = "voltage_v = 10, resistance_ohm = 2, capacity_ah = 10";

TEST(Simulate, PrintsTheCurveAndASummaryLine) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", lasting);
    const auto result = run(folder, "simulate", "m.toml --step 1800");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out,
              "time_s,phase,mechanical_w,compute_w,power_w,current_a,soc_percent,terminal_voltage_v\n"
              "0,cruise,0,25,25,2.5,100,10\n1800,cruise,0,25,25,2.5,87.5,10\n3600,cruise,0,25,25,2.5,75,10\n");
    EXPECT_EQ(result.err,
              "flightwatt-simulate: m: 75.00 % left after 1 h; 25.000 Wh, 0.000 mechanical and 25.000 "
              "computing\n");
}

TEST(Simulate, StepsBySecondsUnlessTold) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", lasting);
    const auto result = run(folder, "simulate", "m.toml");
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 3602);
    for (const auto* step : {"0", "-1", "nan", "1x", "1e-9"}) {
        EXPECT_EQ(run(folder, "simulate", std::string("m.toml --step=") + step).code, 2) << step;
    }
}

TEST(Simulate, PrintsJson) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", lasting);
    const auto result = run(folder, "simulate", "m.toml --json -o curve.csv");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    const auto json = nlohmann::ordered_json::parse(result.out);
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    EXPECT_THAT(keys,
                testing::ElementsAre("format", "stage", "mission", "final_soc_percent", "reserve_soc_percent",
                                     "keeps_reserve", "energy_wh", "mechanical_energy_wh", "compute_energy_wh",
                                     "delivered_energy_wh", "duration_s", "depleted_at_s", "cut_off_at_s", "feasible"));
    EXPECT_EQ(json["mission"], "m");
    EXPECT_NEAR(json["final_soc_percent"].get<double>(), 75.0, 1e-9);
    EXPECT_EQ(json["compute_energy_wh"], 25.0);
    EXPECT_EQ(json["duration_s"], 3600.0);
    EXPECT_TRUE(json["depleted_at_s"].is_null());
    EXPECT_EQ(json["feasible"], true);
    EXPECT_THAT(read_file(folder / "curve.csv"), EndsWith("\n3600,cruise,0,25,25,2.5,75,10\n"));
    EXPECT_EQ(nlohmann::json::parse(run(folder, "simulate", "m.toml --json").out)["mission"], "m");
}

TEST(Simulate, AnswersForABatteryThatRunsEmpty) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", small);
    const auto result = run(folder, "simulate", "m.toml --json");
    EXPECT_EQ(result.code, 0);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_NEAR(json["depleted_at_s"].get<double>(), 2880.0, 1e-8);
    EXPECT_EQ(json["final_soc_percent"], 0.0);
    EXPECT_EQ(json["feasible"], false);
    EXPECT_NEAR(json["delivered_energy_wh"].get<double>(), 20.0, 1e-9);
    EXPECT_EQ(json["energy_wh"], 25.0);
}

TEST(Simulate, HasNoAnswerWhereTheBatteryCannotDeliver) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", weak);
    const auto result = run(folder, "simulate", "m.toml -o curve.csv");
    EXPECT_EQ(result.code, 4);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err,
              "flightwatt-simulate: error: m: the battery cannot deliver 25 W after 0.0 s: its limit U^2 / (4 R) "
              "is 12.5 W\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "curve.csv"));
}

TEST(Simulate, RefusesABadMission) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", "voltage_v = 10, resistance_ohm = 0");
    const auto result = run(folder, "simulate", "m.toml");
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "flightwatt-simulate: m.toml:3:11: error: has no key 'capacity_ah'\n");
    EXPECT_EQ(run(folder, "simulate", "a.toml b.toml").code, 2);
    EXPECT_EQ(run(folder, "simulate", "").code, 2);
}

TEST(Compare, RanksMissions) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "smaller", smaller);
    write_mission(folder, "lasting", lasting);
    write_mission(folder, "small", small);
    const auto result = run(folder, "compare", "smaller.toml lasting.toml small.toml");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out,
              "rank  mission  final state of charge [%]  reserve [%]  energy [Wh]  me"
              "chanical [Wh]  computing [Wh]  duration [s]  empty at [s]\n"
              "   1  lasting                      75.00         0.00       25.000    "
              "        0.000          25.000        3600.0             -\n"
              "   2  small                         0.00         0.00       25.000    "
              "        0.000          25.000        3600.0        2880.0\n"
              "   3  smaller                       0.00         0.00       25.000    "
              "        0.000          25.000        3600.0        1440.0\n");
    EXPECT_EQ(run(folder, "compare", "small.toml smaller.toml lasting.toml").out, result.out);
    run(folder, "compare", "small.toml -o table.md");
    EXPECT_THAT(read_file(folder / "table.md"), StartsWith("| rank | mission | final state of charge [%] |"));
}

TEST(Compare, ListsSummariesAsJson) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "small", small);
    write_mission(folder, "lasting", lasting);
    const auto result = run(folder, "compare", "small.toml lasting.toml --json -o table.txt");
    const auto json = nlohmann::json::parse(result.out)["missions"];
    ASSERT_EQ(json.size(), 2U);
    EXPECT_EQ(json[0]["mission"], "lasting");
    EXPECT_EQ(json[1]["mission"], "small");
    EXPECT_NEAR(json[1]["depleted_at_s"].get<double>(), 2880.0, 1e-8);
    EXPECT_THAT(read_file(folder / "table.txt"), StartsWith("rank  mission"));
}

TEST(Compare, TableAsCsvHasAllDigits) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "m", "voltage_v = 10, resistance_ohm = 0.3, capacity_ah = 7");
    const auto result = run(folder, "compare", "m.toml --json -o table.csv");
    const auto json = nlohmann::json::parse(result.out)["missions"][0];
    const auto table = read_csv(folder / "table.csv");
    ASSERT_EQ(table.rows.size(), 1U);
    for (const auto* key : {"final_soc_percent", "delivered_energy_wh"}) {
        const auto column = std::ranges::find(table.columns, key) - table.columns.begin();
        EXPECT_EQ(std::stod(table.rows[0].cells.at(static_cast<std::size_t>(column)).text), json[key].get<double>())
            << key;
    }
}

TEST(Compare, RanksWhatCannotBeDeliveredLast) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "weak", weak);
    write_mission(folder, "small", small);
    const auto result = run(folder, "compare", "weak.toml small.toml --json");
    EXPECT_EQ(result.code, 4);
    EXPECT_EQ(result.err,
              "flightwatt-compare: warning: weak: the battery cannot deliver 25 W after 0.0 s: its limit U^2 / (4 R) "
              "is 12.5 W\n");
    const auto json = nlohmann::json::parse(result.out)["missions"];
    EXPECT_EQ(json[0]["mission"], "small");
    EXPECT_EQ(json[1]["mission"], "weak");
    EXPECT_TRUE(json[1]["final_soc_percent"].is_null());
    EXPECT_EQ(json[1]["feasible"], false);
    EXPECT_THAT(run(folder, "compare", "weak.toml").out, HasSubstr("   1  weak                             -"));
}

TEST(Compare, StopsAtABadMission) {
    const auto folder = test::scratch_dir();
    write_mission(folder, "good", lasting);
    write_mission(folder, "bad", "voltage_v = 0, resistance_ohm = 0, capacity_ah = 1");
    const auto result = run(folder, "compare", "good.toml bad.toml");
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err,
              "flightwatt-compare: bad.toml:3:13: error: voltage_v = 0, expected more than 0 and at most 1000000\n");
}

TEST(Compare, ReproducesThePaper) {
    const auto folder = test::scratch_dir();
    const auto missions = (test::source_dir() / "missions" / "paper").string() + "/*.toml";
    const auto result = run(folder, "compare", "--json " + missions);
    EXPECT_EQ(result.code, 0);
    std::vector<std::string> names;
    const auto json = nlohmann::json::parse(result.out);
    for (const auto& summary : json["missions"]) names.push_back(summary["mission"]);
    EXPECT_THAT(names, testing::ElementsAre("computing-only", "mechanical-only", "invariant-5.8fps-32bit", "adaptive",
                                            "plan", "invariant-10fps-240bit", "adaptive-replanned", "phased",
                                            "invariant-32fps-448bit"));
}

}  // namespace
}  // namespace flightwatt::mission
