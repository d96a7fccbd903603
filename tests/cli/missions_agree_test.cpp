// What is stated of a mission is the same everywhere: simulate, its CSV, compare, report --json and the page.

#include "base/atomic_file.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {
namespace {

using Json = nlohmann::json;

/// A mission file with drawn battery, capacity, reserve, duration and software.
std::string generated_mission(std::mt19937& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const bool is_thevenin = between(0.0, 1.0) < 0.6;
    auto text = fmt::format(
        "mechanical = \"fits/mechanical/{}.toml\"\nbattery = \"fits/battery/{}.toml\"\ncapacity_ah = {:.3f}\n"
        "reserve_soc_percent = {:.1f}\nduration_s = {{ cruise = {:.1f} }}\n",
        between(0.0, 1.0) < 0.5 ? "synthetic-wing" : "opterra-table1", is_thevenin ? "synthetic-3s" : "paper",
        between(0.8, 3.0), between(5.0, 30.0), between(300.0, 1500.0));
    if (is_thevenin && between(0.0, 1.0) < 0.5) text += fmt::format("cutoff_voltage_v = {:.2f}\n", between(9.5, 11.0));
    text += "[components.detection]\nprofile = \"fits/compute/tx2-detection.csv\"\nutility = { parameter = \"fps\" }\n";
    return text + fmt::format("[[schedule]]\notherwise = true\nrun = {{ detection = {{ fps = {:.1f} }} }}\n",
                              between(6.0, 32.0));
}

struct CsvSums {
    double last_s = 0.0, last_percent = 0.0, energy_wh = 0.0, mechanical_wh = 0.0, compute_wh = 0.0;
};

CsvSums sums_of(const std::string& csv) {
    CsvSums sums;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    std::vector<double> before;
    while (std::getline(lines, line)) {
        std::vector<double> row;  // time, mechanical, compute, power, current, charge, voltage
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');)
            if (cell.find_first_not_of("0123456789.eE+-") == std::string::npos) row.push_back(std::stod(cell));
        EXPECT_EQ(row.size(), 7U) << line;
        if (!before.empty()) {
            const double half_h = (row[0] - before[0]) / 2.0 / 3600.0;
            sums.mechanical_wh += half_h * (before[1] + row[1]);
            sums.compute_wh += half_h * (before[2] + row[2]);
            sums.energy_wh += half_h * (before[3] + row[3]);
        }
        before = row;
    }
    sums.last_s = before.at(0);
    sums.last_percent = before.at(5);
    return sums;
}

void expect_one_answer(const std::filesystem::path& folder) {
    const auto run = [&](const std::string& command) {
        const auto done = test::run_shell("flightwatt " + command, folder);
        EXPECT_EQ(done.code, 0) << command << '\n' << done.err;
        return done.out;
    };
    const auto simulated = Json::parse(run("simulate m.toml --json"));
    const auto csv = sums_of(run("simulate m.toml --step 0.5"));
    const auto compared = Json::parse(run("compare m.toml --json")).at("missions").at(0);
    const auto reported = Json::parse(run("report m.toml --json -o page.html")).at("missions").at(0);
    for (const auto& [key, value] : simulated.items()) {
        for (const auto& other : {compared, reported}) {
            if (!other.contains(key)) continue;
            if (value.is_number())  // integrated from row to row, and rows differ
                EXPECT_NEAR(other.at(key).get<double>(), value.get<double>(), 1e-6 * (1.0 + value.get<double>()))
                    << key;
            else
                EXPECT_EQ(other.at(key), value) << key;
        }
    }
    EXPECT_TRUE(reported.contains("final_soc_percent") && reported.contains("utility"));
    EXPECT_NEAR(csv.energy_wh, simulated.at("energy_wh"), 2e-4 * csv.energy_wh);
    EXPECT_NEAR(csv.mechanical_wh, simulated.at("mechanical_energy_wh"), 2e-4 * csv.energy_wh);
    EXPECT_NEAR(csv.compute_wh, simulated.at("compute_energy_wh"), 2e-4 * csv.energy_wh);
    EXPECT_NEAR(csv.last_s, simulated.at("duration_s"), 1e-6);
    EXPECT_NEAR(csv.last_percent, simulated.at("final_soc_percent"), 1e-6);
    const auto page = test::run_shell("sed -n 's/.*id=\"document\">\\(.*\\)<.script>.*/\\1/p' page.html", folder);
    const auto shown = Json::parse(page.out).at("missions").at(0);
    EXPECT_NEAR(shown.at("summary").at("duration_s"), simulated.at("duration_s"), 0.051);
    if (simulated.at("feasible")) {
        EXPECT_NEAR(shown.at("landing_soc_percent"), simulated.at("final_soc_percent"), 0.051);
    } else {
        EXPECT_TRUE(shown.at("landing_soc_percent").is_null()) << "it does not land";
    }
}

TEST(MissionsAgree, OnEachNumberOfGeneratedMissions) {
    std::mt19937 random(4807);
    const auto folder = test::scratch_dir();
    std::filesystem::create_directory_symlink(test::source_dir() / "fits", folder / "fits");
    for (int i = 0; i < 8; ++i) {
        const auto text = generated_mission(random);
        SCOPED_TRACE(text);
        write_file_atomically(folder / "m.toml", text);
        expect_one_answer(folder);
    }
}

}  // namespace
}  // namespace flightwatt::cli
