// flightwatt-validate and flightwatt-predict as a user runs them.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::mechanical {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

test::ProgramResult run(const std::filesystem::path& folder, const std::string& arguments) {
    return test::run_shell("flightwatt " + arguments, folder);
}

std::string sample(const std::string& number) {
    return " '" + (test::source_dir() / "logs" / ("opterra_synthetic_" + number + ".data")).string() + "'";
}

std::string samples() {
    std::string files;
    for (const auto* number : {"01", "02", "03", "04", "05", "06"}) files += sample(number);
    return files;
}

std::string real_flights() {
    std::string files;
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        files += " '" + (test::shared_dir() / "flights" / (std::string(name) + ".data")).string() + "'";
    }
    return files;
}

TEST(Validate, PrintsEveryModelOfEveryPart) {
    const auto result = run(test::scratch_dir(), "validate" + samples());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("opterra_synthetic_06  total    constant_mean"));
    EXPECT_THAT(result.out, HasSubstr("coverage of 6 flights is uncertain"));
}

TEST(Validate, PrintsJson) {
    const auto result = run(test::scratch_dir(), "validate --json" + samples());
    ASSERT_EQ(result.code, 0) << result.err;
    const auto json = Json::parse(result.out);
    EXPECT_EQ(json["flights"], 6);
    for (const auto* part : {"takeoff", "cruise", "landing", "total"}) {
        for (const auto* model : {"fourier", "constant_mean"}) {
            const auto& score = json.at(part).at(model);
            EXPECT_GT(score.at("mean_absolute_error_wh"), 0.0);
            EXPECT_EQ(score.at("mean_absolute_error_percent").is_null(), std::string(part) == "landing");
            EXPECT_LE(std::abs(score.at("bias_wh").get<double>()), score.at("mean_absolute_error_wh").get<double>());
            EXPECT_LE(score.at("coverage_95"), 1.0);
        }
    }
}

TEST(Validate, RefusesOneFlightAndMomentsThatAreNone) {
    const auto folder = test::scratch_dir();
    const auto one = run(folder, "validate" + sample("01"));
    EXPECT_EQ(one.code, 4);
    EXPECT_THAT(one.err, HasSubstr("cross-validation needs 2 or more"));
    EXPECT_EQ(run(folder, "validate --at -5" + samples()).code, 2);
    const auto late = run(folder, "validate --at 5000" + samples());
    EXPECT_EQ(late.code, 4);
    EXPECT_THAT(late.err, HasSubstr("not in the air at the moment: 6 logs"));
}

TEST(ValidateStudy, InFlightBeatsBeforeFlightOnRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    const auto before = Json::parse(run(folder, "validate --json" + real_flights()).out);
    // 300 s after lift-off, and after 300 s of cruise (the take-offs last 27 to 35 s).
    for (const auto* until : {"300", "330"}) {
        const auto during =
            Json::parse(run(folder, std::string("validate --json --until ") + until + real_flights()).out);
        for (const auto* part : {"cruise", "total"}) {
            for (const auto* key : {"mean_absolute_error_wh", "mean_absolute_error_percent"}) {
                for (const auto* model : {"in_flight", "in_flight_constant", "in_flight_physical"}) {
                    EXPECT_LT(during[part][model][key], before[part]["fourier"][key]) << part << until;
                    EXPECT_LT(during[part][model][key], before[part]["constant_mean"][key]) << part << until;
                    EXPECT_LT(during[part][model][key], during[part]["fourier"][key]) << part << until;
                }
            }
        }
    }
}

TEST(Validate, AirspeedAndClimbExplainFlightsThatWereNotFitted) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto json = Json::parse(run(test::scratch_dir(), "validate --json" + real_flights()).out);
    const auto& physical = json["cruise"]["physical"];
    EXPECT_EQ(physical["flights"], 3);
    EXPECT_LT(physical["mean_absolute_error_percent"], 5.0);
    EXPECT_EQ(physical["coverage_95"], 1.0);
    EXPECT_EQ(json["total"]["physical"]["coverage_95"], 1.0);
    EXPECT_LE(json["takeoff"]["physical"]["mean_absolute_error_percent"], 10.0);
    EXPECT_LE(json["total"]["physical"]["mean_absolute_error_percent"], 3.0);
}

TEST(Validate, KnowsTheRestOfACruiseByItsPath) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto json = Json::parse(run(test::scratch_dir(), "validate --at 300 --json" + real_flights()).out);
    EXPECT_LT(json["cruise"]["in_flight_physical"]["mean_absolute_error_wh"],
              0.6 * json["cruise"]["in_flight"]["mean_absolute_error_wh"].get<double>());
    EXPECT_EQ(json["cruise"]["in_flight_physical"]["coverage_95"], 1.0);
}

TEST(Fit, TellsThePhysicsOfRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    const auto result =
        run(folder, "fit --model-kind physical --json -o model.toml --constants constants.csv" + real_flights());
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(read_file(folder / "constants.csv"), HasSubstr("\ndrag,0.00"));
    const auto physical = Json::parse(result.out)["physical"];
    EXPECT_EQ(physical["terms"][0]["term"], "drag");
    EXPECT_NEAR(physical["terms"][0]["coefficient"], 0.0095, 0.001);
    EXPECT_EQ(physical["terms"][1]["term"], "climb");
    EXPECT_GT(physical["terms"][1]["coefficient"], 8.0);
    EXPECT_EQ(physical["terms"][2]["term"], "descent");
    EXPECT_EQ(physical["flights"].size(), 3u);
    EXPECT_EQ(run(folder, "predict --model model.toml --at 300 --remaining 300 --airspeed 13" +
                              real_flights().substr(0, real_flights().find(".data'") + 6))
                  .code,
              0);
}

std::string physical_table(const std::filesystem::path& model) {
    const auto text = read_file(model);
    return text.substr(text.find("[physical]"));
}

TEST(Fit, OfABatchFindsTheSamePhysics) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit --model-kind physical -o model.toml" + real_flights()).code, 0);
    const auto batch = "batch --model-kind physical -o out" + real_flights();
    const auto first = run(folder, batch);
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("climb "));
    EXPECT_EQ(physical_table(folder / "out/model.toml"), physical_table(folder / "model.toml"));
    const auto again = run(folder, batch + " --json");  // from its records
    EXPECT_THAT(again.err, HasSubstr("up to date"));
    EXPECT_EQ(Json::parse(again.out)["physical"]["flights"].size(), 3u);
    EXPECT_EQ(physical_table(folder / "out/model.toml"), physical_table(folder / "model.toml"));
}

TEST(Fit, RefusesAPhysicalModelWithoutAirspeed) {
    const auto folder = test::scratch_dir();
    const auto result = run(folder, "fit --model-kind physical -o model.toml" + sample("01") + sample("02"));
    EXPECT_EQ(result.code, 4);
    EXPECT_THAT(result.err, HasSubstr("opterra_synthetic_01: its airspeed was not measured"));
    EXPECT_FALSE(std::filesystem::exists(folder / "model.toml"));
    EXPECT_EQ(run(folder, "batch --model-kind physical -o out" + sample("01") + sample("02")).code, 4);
    EXPECT_FALSE(std::filesystem::exists(folder / "out/model.toml"));
    for (const std::string program : {"fit", "batch -o other"}) {
        const auto usage = run(folder, program + " --model newton" + sample("01"));
        EXPECT_EQ(usage.code, 2);
        EXPECT_THAT(usage.err, HasSubstr("--model-kind newton: expected one of fourier, physical, best"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "other"));
}

/// The lines of a log up to a time.
void write_cut_log(const std::filesystem::path& from, const std::filesystem::path& to, double until_s) {
    std::ifstream in(from);
    std::ofstream out(to);
    std::string line;
    while (std::getline(in, line)) {
        if (line.starts_with("#") || std::stod(line) <= until_s) out << line << '\n';
    }
    std::filesystem::copy_file(std::filesystem::path(from).replace_extension(".log"),
                               std::filesystem::path(to).replace_extension(".log"));
}

void expect_same_when_cut(const std::filesystem::path& log, const std::string& fit_files, const std::string& until_s) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + fit_files).code, 0);
    const auto options = "--json --model model.toml --remaining 200 --until " + until_s;
    const auto whole = run(folder, "predict " + options + " '" + log.string() + "'");
    ASSERT_EQ(whole.code, 0) << whole.err;
    const auto json = Json::parse(whole.out);
    write_cut_log(log, folder / "cut.data", json["until_s"]);
    EXPECT_EQ(run(folder, "predict " + options + " cut.data").out, whole.out);
    EXPECT_NEAR(json["total_energy_wh"],
                json["flown_energy_wh"].get<double>() + json["remaining_energy_wh"].get<double>(), 1e-12);
    EXPECT_LT(json["remaining_energy_wh_interval_95"]["low"], json["remaining_energy_wh"]);
    EXPECT_GT(json["remaining_energy_wh_interval_95"]["high"], json["remaining_energy_wh"]);
}

TEST(Predict, IsTheSameWhereTheLogEndsAtTheMoment) {
    expect_same_when_cut(test::source_dir() / "logs" / "opterra_synthetic_01.data", samples(), "300");
}

TEST(Predict, IsTheSameWhereARealLogEndsAtTheMoment) {
    FLIGHTWATT_NEEDS_SHARED();
    expect_same_when_cut(test::shared_dir() / "flights" / "20_07_05__10_26_44.data", real_flights(), "300");
}

TEST(Predict, IsAboutNowWhereNoMomentIsGiven) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + samples()).code, 0);
    write_cut_log(test::source_dir() / "logs" / "opterra_synthetic_01.data", folder / "growing.data", 400.0);
    const auto now = run(folder, "predict --json --model model.toml --remaining 200 growing.data");
    ASSERT_EQ(now.code, 0) << now.err;
    const double until_s = Json::parse(now.out)["until_s"];
    EXPECT_NEAR(until_s, 400.0, 2.0);
    EXPECT_EQ(run(folder, "predict --json --model model.toml --remaining 200 growing.data").out, now.out);
    const auto at = run(folder, "predict --json --model model.toml --remaining 200 --at-log-time " +
                                    std::to_string(until_s) + " growing.data");
    EXPECT_EQ(at.out, now.out);
}

TEST(Predict, TellsHowTheBatteryLands) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + samples()).code, 0);
    const auto pack = "'" + (test::source_dir() / "fits" / "battery" / "synthetic-3s.toml").string() + "'";
    const auto predict = "predict --json --model model.toml --at 300 --remaining 290 --battery " + pack;
    const auto result = run(folder, predict + sample("01"));
    ASSERT_EQ(result.code, 0) << result.err;
    const auto json = Json::parse(result.out);
    const auto& battery = json["battery"];
    EXPECT_NEAR(battery["initial_soc_percent"], 100.0, 0.5);
    // The energy that was flown, and is to be, of about 37.5 Wh (3.2 Ah at 11.7 V)
    EXPECT_NEAR(battery["soc_now_percent"], 100.0 - 100.0 * json["flown_energy_wh"].get<double>() / 37.5, 1.5);
    EXPECT_NEAR(battery["at_landing"]["soc_percent"], 100.0 - 100.0 * json["total_energy_wh"].get<double>() / 37.5,
                2.0);
    EXPECT_GT(battery["at_landing"]["soc_percent"], battery["at_landing_high_energy"]["soc_percent"]);
    EXPECT_GT(battery["at_landing"]["endurance_s"], 3000.0);
    EXPECT_TRUE(battery["at_landing"]["fails_after_s"].is_null());
    const auto low = Json::parse(run(folder, predict + " --initial-soc 9" + sample("01")).out)["battery"];
    EXPECT_EQ(low["initial_soc_percent"], 9.0);
    EXPECT_FALSE(low["at_landing"]["fails_after_s"].is_null());
    EXPECT_EQ(run(folder, predict + " --initial-soc 1" + sample("01")).code, 4);  // more was drawn already
    EXPECT_EQ(run(folder, predict + " --initial-soc 101" + sample("01")).code, 2);
    EXPECT_EQ(run(folder, "predict --model model.toml --at 300 --remaining 9 --initial-soc 50" + sample("01")).code, 2);
}

TEST(Predict, NeedsAPhysicalModelForAnAirspeed) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + samples()).code, 0);
    const auto predict = "predict --model model.toml --at 300 --remaining 100 ";
    const auto result = run(folder, predict + std::string("--airspeed 13") + sample("01"));
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err, HasSubstr("it has no [physical]"));
    EXPECT_EQ(run(folder, predict + std::string("--airspeed 0") + sample("01")).code, 2);
    EXPECT_EQ(run(folder, predict + std::string("--climb 1") + sample("01")).code, 2);
}

TEST(Predict, ForeseesASampleFlight) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + sample("02") + sample("03") + sample("04") + sample("05")).code, 0);
    // It lifts off at 64.5 s and begins to land at 661.9 s, after 4.54 Wh; 5.017 Wh in all.
    const auto result = run(folder, "predict --json --model model.toml --at 400 --remaining 197.4" + sample("01"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NEAR(Json::parse(result.out)["total_energy_wh"], 5.017, 0.1);
}

TEST(Predict, RefusesWhatCannotBePredicted) {
    const auto folder = test::scratch_dir();
    const auto published = "'" + (test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml").string() + "'";
    const auto without = run(folder, "predict --model " + published + " --at 300 --remaining 9" + sample("01"));
    EXPECT_EQ(without.code, 3);
    EXPECT_THAT(without.err, HasSubstr("does not show how the power of flights differs in cruise"));
    ASSERT_EQ(run(folder, "fit -o model.toml" + samples()).code, 0);
    const auto predict = [&](const std::string& options) {
        return run(folder, "predict --model model.toml " + options + sample("01")).code;
    };
    EXPECT_EQ(predict("--at 300 --remaining 100"), 0);
    EXPECT_EQ(predict("--at 300"), 2);
    EXPECT_EQ(predict("--remaining 100"), 4);  // now: landed
    EXPECT_EQ(predict("--at soon --remaining 100"), 2);
    EXPECT_EQ(predict("--at 300 --at-log-time 300 --remaining 100"), 2);
    EXPECT_EQ(predict("--at 300 --remaining=-1"), 2);
    EXPECT_EQ(predict("--at nan --remaining 1"), 2);
    EXPECT_EQ(predict("--at 10 --remaining 100"), 0);   // climbing
    EXPECT_EQ(predict("--at 700 --remaining 100"), 4);  // landed
    EXPECT_EQ(predict("--at 300 --remaining 100 --sortie 2"), 4);
}

}  // namespace
}  // namespace flightwatt::mechanical
