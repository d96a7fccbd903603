// What flightwatt export writes of everything, and its tables as LaTeX reads them.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"
#include "mechanical/mechanical_model.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

/// `flightwatt export ARGUMENTS` in a folder that has the project's files as $S.
test::ProgramResult exported(const std::string& arguments, const std::filesystem::path& folder) {
    return test::run_shell("S=" + test::shell_quoted(test::source_dir()) + "; flightwatt export " + arguments, folder);
}

/// Compiles a document of all these tables; its errors, and the boxes that are too wide.
void expect_compiled(const std::vector<std::string>& tables, const std::filesystem::path& folder) {
    std::string document =
        "\\documentclass{article}\n\\usepackage{booktabs,graphicx}\n\\usepackage[T1]{fontenc}\n"
        "\\begin{document}\n";
    for (const auto& table : tables) document += "\\input{" + table + "}\n";
    write_file_atomically(folder / "all.tex", document + "\\end{document}\n");
    const auto result = test::run_shell("pdflatex -halt-on-error -interaction=nonstopmode all.tex", folder);
    EXPECT_EQ(result.code, 0) << result.out;
    EXPECT_TRUE(std::filesystem::exists(folder / "all.pdf"));
    EXPECT_EQ(result.out.find("Overfull"), std::string::npos) << result.out;
}

TEST(ExportLatex, IsCompiledByLatex) {
    const auto folder = test::scratch_dir();
    if (test::run_shell("kpsewhich booktabs.sty", folder).code != 0)
        GTEST_SKIP() << "LaTeX is not here (apt-get install texlive-latex-recommended)";
    // A name with all that TeX reads otherwise.
    const auto made =
        test::run_shell("S=" + test::shell_quoted(test::source_dir()) +
                            "; for e in data log; do cp $S/logs/opterra_synthetic_01.$e 'a_b%{&}#$^~.'$e; "
                            "done; flightwatt batch $S/logs/opterra_synthetic_0[2-3].data a_b*.data -o out",
                        folder);
    ASSERT_EQ(made.code, 0) << made.err;
    for (const auto* words : {"out -o flights.tex", "$S/fits/mechanical/opterra-table1.toml -o published.tex",
                              "$S/fits/mechanical/synthetic-wing.toml -o wing.tex",
                              "$S/fits/battery/synthetic-3s.toml -o pack.tex", "out/model_errors.toml -o errors.tex",
                              "$S/missions/paper/phased.toml $S/missions/paper/plan.toml -o missions.tex"}) {
        const auto result = exported(words, folder);
        EXPECT_EQ(result.code, 0) << words << result.err;
    }
    EXPECT_THAT(read_file(folder / "flights.tex"), HasSubstr("a\\_b\\%\\{\\&\\}\\#\\$"));
    EXPECT_THAT(read_file(folder / "flights.tex"), HasSubstr("\\label{tab:validation}"));
    EXPECT_THAT(read_file(folder / "published.tex"), HasSubstr("$a_{0}$ & $29.97$ & $27.22$ & $27.21$"));
    EXPECT_THAT(read_file(folder / "missions.tex"), HasSubstr("\\label{tab:missions}"));
    for (const auto* label : {"identified-battery", "battery-flights"})
        EXPECT_THAT(read_file(folder / "flights.tex"), HasSubstr(std::string("\\label{tab:") + label + "}"));
    expect_compiled({"flights", "published", "wing", "pack", "errors", "missions"}, folder);
}

TEST(ExportLatex, HasTheReplayOfMissionsOnTheFlights) {
    const auto folder = test::scratch_dir();
    const auto made = test::run_shell("S=" + test::shell_quoted(test::source_dir()) +
                                          "; flightwatt batch $S/logs/opterra_synthetic_0[1-3].data -o out",
                                      folder);
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string mission = "$S/missions/paper/phased.toml";
    const auto result = exported(mission + " out --replay --capacity 4 -o both.tex", folder);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto text = read_file(folder / "both.tex");
    for (const auto* label : {"flights", "missions", "replay", "replay-basis"})
        EXPECT_THAT(text, HasSubstr(std::string("\\label{tab:") + label + "}"));
    EXPECT_THAT(text, HasSubstr("capacity {[}Ah] & $4$ & -- & given"));
    EXPECT_EQ(exported("out --replay -o t.tex", folder).code, 2);
    EXPECT_EQ(exported(mission + " --replay -o t.tex", folder).code, 2);
    EXPECT_EQ(exported(mission + " --capacity 4 -o t.tex", folder).code, 2);
    EXPECT_EQ(exported("out out -o t.tex", folder).code, 2);
    EXPECT_EQ(exported("out --capacity -4 -o t.tex", folder).code, 2);
    if (test::run_shell("kpsewhich booktabs.sty", folder).code == 0) expect_compiled({"both"}, folder);
}

TEST(Export, TakesTheFormFromTheNameOfTheFile) {
    const auto folder = test::scratch_dir();
    const std::string log = "$S/logs/opterra_synthetic_01.data";
    const std::string model = "$S/fits/mechanical/synthetic-wing.toml";
    for (const auto& [words, beginning] : std::vector<std::pair<std::string, std::string>>{
             {log + " -o t.geojson", "{\"type\":\"FeatureCollection\""},
             {log + " -o t.kml", "<?xml"},
             {log + " -o t.gpx", "<?xml"},
             {log + " -o t.csv", "time_s,"},
             {log + " --message GPS -o t.csv", "time_s,mode"},
             {model + " -o t.json", "{"},
             {model + " -o t.h", "/* Electrical power"},
             {model + " $S/fits/battery/synthetic-3s.toml --cells 3 -o t.params", "# Written by flightwatt"},
             {"$S/missions/synthetic/survey-path.toml --format paparazzi --parallel 2 -o t.py", "# Written by"},
             {"$S/missions/synthetic/survey-path.toml --format inav --idle-power 0 -o t.txt", "# Written by"}}) {
        const auto result = exported(words, folder);
        EXPECT_EQ(result.code, 0) << words << ": " << result.err;
        const auto file = words.substr(words.rfind(' ') + 1);
        EXPECT_TRUE(read_file(folder / file).starts_with(beginning)) << words;
    }
}

TEST(Export, AddsTheMissionsComputer) {
    const auto folder = test::scratch_dir();
    const auto result = exported("$S/missions/paper/phased.toml --format inav", folder);
    EXPECT_EQ(result.code, 0) << result.err;
    const auto summary = test::run_shell(
        "flightwatt simulate " + test::shell_quoted(test::source_dir() / "missions/paper/phased.toml") + " --json",
        folder);
    const auto json = nlohmann::json::parse(summary.out);
    const double compute_cw =
        100.0 * 3600.0 * json.at("compute_energy_wh").get<double>() / json.at("duration_s").get<double>();
    const auto at = result.out.find("idle_power = ");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(result.out.substr(at + 13)), compute_cw, 0.51);
}

TEST(Export, JsonOfAModelIsThatOfItsFileAlsoWhereMeanPowerPredicts) {
    const auto folder = test::scratch_dir();
    auto model = mechanical::read_mechanical_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    auto& cruise = model.phases[flight::Phase::cruise];
    cruise.power = {mechanical::PowerBasis::mean, "tried"};
    cruise.fourier.cos_w = {1.0, 2.0, 3.0};
    cruise.fourier.sin_w = {4.0, 5.0, 6.0};
    model.flights = {{"made-up-1", {}}};
    model.flights[0].phases[flight::Phase::cruise] = mechanical::PhaseContribution{
        .weight = 1.0, .duration_s = 600.0, .rms_w = 1.0, .samples = 600, .mean_power_w = 25.0};
    write_file_atomically(folder / "m.toml", to_toml(model));
    const auto result = exported("m.toml --format json", folder);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out).at("cruise");
    EXPECT_EQ(json.at("power"), "mean");
    EXPECT_EQ(json.at("a0_w").get<double>(), cruise.fourier.a0_w);
    EXPECT_EQ(json.at("cos_w").get<std::vector<double>>(), cruise.fourier.cos_w);
}

TEST(Export, MapOfPaparazziIsOfTheBatteryWithOrWithoutAModel) {
    const auto folder = test::scratch_dir();
    const std::string pack = "$S/fits/battery/synthetic-3s.toml --format paparazzi-map";
    const auto alone = exported(pack, folder);
    EXPECT_EQ(alone.code, 0) << alone.err;
    const auto with_model = exported("$S/fits/mechanical/synthetic-wing.toml " + pack, folder);
    EXPECT_EQ(with_model.code, 0) << with_model.err;
    EXPECT_EQ(with_model.out, alone.out);
    const auto model = exported("$S/fits/mechanical/synthetic-wing.toml --format paparazzi-map", folder);
    EXPECT_EQ(model.code, 3);
    EXPECT_THAT(model.err, HasSubstr("needs a battery"));
}

TEST(Export, FailsafesOfAMissionCountItsWind) {
    const auto folder = test::scratch_dir();
    const std::string words = "$S/missions/synthetic/survey-path.toml --format failsafe-ardupilot --home-distance 1800";
    const auto left_mah = [&](const test::ProgramResult& result) {
        EXPECT_EQ(result.code, 0) << result.err;
        const auto at = result.out.find("BATT_LOW_MAH ");
        return at == std::string::npos ? 0.0 : std::stod(result.out.substr(at + 13));
    };
    const auto of_mission = exported(words, folder);
    EXPECT_THAT(of_mission.out, HasSubstr("wind: 4 m/s with a standard deviation of 1 m/s, as the mission states, from "
                                          "ahead, the worst, all the way home"));
    const auto calm = exported(words + " --wind 0", folder);
    EXPECT_THAT(calm.out, HasSubstr("wind: calm"));
    EXPECT_GT(left_mah(of_mission), left_mah(exported(words + " --wind 3.9", folder)));
    EXPECT_GT(left_mah(of_mission), left_mah(calm));
}

TEST(Export, OfALogAndItsSeriesIsTheSame) {
    const auto folder = test::scratch_dir();
    const auto made = test::run_shell(
        "flightwatt parse " + test::shell_quoted(test::source_dir() / "logs/opterra_synthetic_01.data") + " -o s.csv",
        folder);
    ASSERT_EQ(made.code, 0) << made.err;
    for (const auto* form : {"geojson", "kml", "gpx", "csv"}) {
        const auto of_log = exported(std::string("$S/logs/opterra_synthetic_01.data --format ") + form, folder);
        const auto of_series = exported(std::string("s.csv --format ") + form, folder);
        EXPECT_EQ(of_log.code, 0) << of_log.err;
        EXPECT_EQ(of_log.out, of_series.out) << form;
    }
}

TEST(Export, SaysWhatATrackLacks) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "bare.csv",
                          "time_s,power_w,latitude_deg,longitude_deg\n"
                          "0,1,43.1,1.2\n1,2,43.2,1.3\n2,3,43.3,1.4\n");
    const auto bare = exported("bare.csv --format gpx", folder);
    EXPECT_EQ(bare.code, 0) << bare.err;
    EXPECT_THAT(bare.err, HasSubstr("neither a .log nor its name contains the date"));
    EXPECT_THAT(bare.err, HasSubstr("has no altitude"));
    EXPECT_EQ(bare.out.find("<time>"), std::string::npos);
    std::filesystem::copy_file(folder / "bare.csv", folder / "20_07_05__10_26_44.csv");
    const auto named = exported("20_07_05__10_26_44.csv --format gpx", folder);
    EXPECT_THAT(named.err, HasSubstr("warning: 20_07_05__10_26_44.csv: no .log contains the date"));
    EXPECT_THAT(named.out, HasSubstr("<time>2020-07-05T10:26:45.000Z</time>"));
    write_file_atomically(folder / "none.csv", "time_s,power_w\n0,1\n1,2\n");
    const auto none = exported("none.csv --format kml", folder);
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.err, HasSubstr("has no positions"));
}

}  // namespace
}  // namespace flightwatt::cli
