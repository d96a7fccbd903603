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
    EXPECT_THAT(result.out, HasSubstr("opterra_synthetic_06  total    nearest_flight"));
    EXPECT_THAT(result.out, HasSubstr("cruise: fourier does not beat constant_mean: "));
    EXPECT_THAT(result.out, HasSubstr("coverage over 6 flights means little"));
}

TEST(Validate, PrintsJson) {
    const auto result = run(test::scratch_dir(), "validate --json" + samples());
    ASSERT_EQ(result.code, 0) << result.err;
    const auto json = Json::parse(result.out);
    EXPECT_EQ(json["flights"], 6);
    for (const auto* part : {"takeoff", "cruise", "landing", "total"}) {
        for (const auto* model : {"fourier", "constant_mean", "nearest_flight"}) {
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
    EXPECT_THAT(one.err, HasSubstr("leaving one out needs 2 or more"));
    EXPECT_EQ(run(folder, "validate --until -5" + samples()).code, 2);
    const auto late = run(folder, "validate --until 5000" + samples());
    EXPECT_EQ(late.code, 4);
    EXPECT_THAT(late.err, HasSubstr("opterra_synthetic_01 is excluded"));
}

TEST(Validate, InFlightBeatsBeforeFlightOnRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto folder = test::scratch_dir();
    const auto before = Json::parse(run(folder, "validate --json" + real_flights()).out);
    // 300 s after lift-off, and after 300 s of cruise (the take-offs last 27 to 35 s).
    for (const auto* until : {"300", "330"}) {
        const auto during =
            Json::parse(run(folder, std::string("validate --json --until ") + until + real_flights()).out);
        for (const auto* part : {"cruise", "total"}) {
            for (const auto* key : {"mean_absolute_error_wh", "mean_absolute_error_percent"}) {
                for (const auto* model : {"in_flight", "in_flight_constant", "in_flight_airspeed"}) {
                    EXPECT_LT(during[part][model][key], before[part]["fourier"][key]) << part << until;
                    EXPECT_LT(during[part][model][key], before[part]["constant_mean"][key]) << part << until;
                    EXPECT_LT(during[part][model][key], during[part]["fourier"][key]) << part << until;
                }
            }
        }
    }
}

TEST(Validate, AirspeedExplainsTheCruiseOfRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto json = Json::parse(run(test::scratch_dir(), "validate --json" + real_flights()).out);
    EXPECT_LT(json["cruise"]["airspeed_cubed"]["mean_absolute_error_percent"], 8.0);
    EXPECT_GT(json["cruise"]["constant_mean"]["mean_absolute_error_percent"], 20.0);
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
    EXPECT_LT(json["interval_95_wh"][0], json["remaining_energy_wh"]);
    EXPECT_GT(json["interval_95_wh"][1], json["remaining_energy_wh"]);
}

TEST(Predict, IsTheSameWhereTheLogEndsAtTheMoment) {
    expect_same_when_cut(test::source_dir() / "logs" / "opterra_synthetic_01.data", samples(), "300");
}

TEST(Predict, IsTheSameWhereARealLogEndsAtTheMoment) {
    FLIGHTWATT_NEEDS_SHARED();
    expect_same_when_cut(test::shared_dir() / "flights" / "20_07_05__10_26_44.data", real_flights(), "300");
}

TEST(Predict, ForeseesASampleFlight) {
    const auto folder = test::scratch_dir();
    ASSERT_EQ(run(folder, "fit -o model.toml" + sample("02") + sample("03") + sample("04") + sample("05")).code, 0);
    // It lifts off at 64.5 s and begins to land at 661.9 s, after 4.54 Wh; 5.017 Wh in all.
    const auto result = run(folder, "predict --json --model model.toml --until 400 --remaining 197.4" + sample("01"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NEAR(Json::parse(result.out)["total_energy_wh"], 5.017, 0.1);
}

TEST(Predict, RefusesWhatCannotBePredicted) {
    const auto folder = test::scratch_dir();
    const auto published = "'" + (test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml").string() + "'";
    const auto without = run(folder, "predict --model " + published + " --until 300 --remaining 9" + sample("01"));
    EXPECT_EQ(without.code, 3);
    EXPECT_THAT(without.err, HasSubstr("[cruise] has no spread"));
    ASSERT_EQ(run(folder, "fit -o model.toml" + samples()).code, 0);
    const auto predict = [&](const std::string& options) {
        return run(folder, "predict --model model.toml " + options + sample("01")).code;
    };
    EXPECT_EQ(predict("--until 300 --remaining 100"), 0);
    EXPECT_EQ(predict("--until 300"), 2);
    EXPECT_EQ(predict("--remaining 100"), 2);
    EXPECT_EQ(predict("--until 300 --until-log-time 300 --remaining 100"), 2);
    EXPECT_EQ(predict("--until 300 --remaining=-1"), 2);
    EXPECT_EQ(predict("--until nan --remaining 1"), 2);
    EXPECT_EQ(predict("--until 10 --remaining 100"), 4);   // climbing
    EXPECT_EQ(predict("--until 700 --remaining 100"), 4);  // landed
    EXPECT_EQ(predict("--until 300 --remaining 100 --level airspeed"), 4);
    EXPECT_EQ(predict("--until 300 --remaining 100 --level constant"), 0);
    EXPECT_EQ(predict("--until 300 --remaining 100 --level flat"), 2);
    EXPECT_EQ(predict("--until 300 --remaining 100 --sortie 2"), 4);
}

}  // namespace
}  // namespace flightwatt::mechanical
