#include "exchange/model_text.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "battery/battery_toml.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::exchange {
namespace {

mechanical::MechanicalModel model_file(const std::string& name) {
    return mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / (name + ".toml"));
}

/// Compiles a program with the header as an autopilot may, runs it, and returns the numbers that it prints.
std::vector<double> printed_by(const mechanical::MechanicalModel& model, const std::string& body) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "model.h", to_c_header(model));
    // Twice, and in a file that uses nothing of it.
    write_file_atomically(folder / "idle.c",
                          "#include \"model.h\"\n#include \"model.h\"\nint idle(void);\n"
                          "int idle(void) { return 0; }\n");
    write_file_atomically(folder / "main.c",
                          "#include <stdio.h>\n#include \"model.h\"\n"
                          "static void p(double v) { printf(\"%.17g\\n\", v); }\n"
                          "int main(void) {\n" +
                              body + "return 0;\n}\n");
    const auto result = test::run_shell(
        "cc -std=c99 -Wall -Wextra -Werror -pedantic -o run main.c idle.c -lm && ./run && "
        "c++ -std=c++17 -Wall -Werror -fsyntax-only -x c++ idle.c",
        folder);
    EXPECT_EQ(result.code, 0) << result.err << to_c_header(model);
    std::vector<double> numbers;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) numbers.push_back(number_or_nan(line));
    return numbers;
}

/// The model and the header, over all phases at the same times.
void expect_same_curves(const mechanical::MechanicalModel& model) {
    const auto prefix = c_prefix(model.name);
    constexpr int points = 301;
    const auto body = fmt::format(
        "int ph, i;\nfor (ph = 0; ph < 3; ++ph) {{\nenum {0}_phase phase = (enum {0}_phase)ph;\n"
        "double whole = {0}_duration_s(phase);\np(whole);\nfor (i = 0; i < {1}; ++i) {{\n"
        "double t = whole * i / {1}.0;\np({0}_power_w(phase, t));\np({0}_energy_j(phase, t));\n"
        "p({0}_flown_power_w(phase, t, whole / 2.0));\n}}\n}}\n",
        prefix, points);
    const auto numbers = printed_by(model, body);
    ASSERT_EQ(numbers.size(), 3U * (1 + 3 * points));
    std::size_t at = 0;
    for (const auto phase : flight::all_phases) {
        const auto& of = model.phases[phase];
        EXPECT_EQ(numbers[at++], of.duration_s);
        const auto flown = time_scaled_model(of, of.duration_s / 2.0, mechanical::PhaseTimeScaling::scaled);
        for (int i = 0; i < points; ++i) {
            const double t = of.duration_s * i / points;
            EXPECT_NEAR(numbers[at++], power_w(of.fourier, t), 1e-6) << prefix << " " << i;
            EXPECT_NEAR(numbers[at++], energy_j(of.fourier, t), 1e-6) << prefix << " " << i;
            EXPECT_NEAR(numbers[at++], power_w(flown, t), 1e-6) << prefix << " " << i;
        }
    }
}

TEST(CHeader, IsTheModelToAMillionth) {
    expect_same_curves(model_file("opterra-table1"));
    expect_same_curves(model_file("synthetic-wing"));
}

TEST(CHeader, IsThePhysicalModelToAMillionth) {
    const auto model = model_file("synthetic-wing");
    const auto numbers = printed_by(model,
                                    "int i, k;\nfor (i = 0; i < 30; ++i)\nfor (k = 0; k < 21; ++k)\n"
                                    "p(synthetic_wing_motion_power_w(5.0 + i, 0.5 * k - 5.0, 1.0 + 0.05 * k));\n");
    ASSERT_EQ(numbers.size(), 630U);
    std::size_t zeros = 0;
    std::size_t number = 0;
    for (int i = 0; i < 30; ++i) {
        for (int k = 0; k < 21; ++k, ++number) {
            const double expected = power_w(*model.physical, {5.0 + i, 0.5 * k - 5.0, 1.0 + 0.05 * k});
            EXPECT_NEAR(numbers[number], expected, 1e-6);
            zeros += expected == 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(zeros, 0U) << "steep descents were not tried";
}

TEST(CHeader, KeepsEveryTermOfAMotion) {
    auto model = model_file("synthetic-wing");
    double value = 0.1;
    model.physical->terms = {mechanical::all_power_terms.begin(), mechanical::all_power_terms.end()};
    for (const auto term : mechanical::all_power_terms) model.physical->coefficients[term] = value *= 1.7;
    model.physical->load = {0.3, mechanical::RotorLoading{2.5, 0.4}};
    const auto numbers = printed_by(model,
                                    "p(synthetic_wing_motion_power_w(12.0, -1.0, 1.3));\n"
                                    "p(synthetic_wing_motion_power_w(12.0, 1.0, 1.3));\n");
    EXPECT_NEAR(numbers.at(0), power_w(*model.physical, {12.0, -1.0, 1.3}), 1e-6);
    EXPECT_NEAR(numbers.at(1), power_w(*model.physical, {12.0, 1.0, 1.3}), 1e-6);
}

TEST(CHeader, IsNotBrokenByAName) {
    auto model = model_file("opterra-table1");
    model.name = "20 Twin-Star */ \"\xC3\xA9?\?/";
    model.description = "/* ends */ here ?\?/\nand continues \\";
    EXPECT_EQ(c_prefix(model.name), "model_20_twin_star__________");
    EXPECT_EQ(printed_by(model, "p(model_20_twin_star___________duration_s(MODEL_20_TWIN_STAR___________CRUISE));\n"),
              std::vector<double>{model.phases[flight::Phase::cruise].duration_s});
}

TEST(CHeader, NamesThePhasesOfMeanPower) {
    auto model = model_file("opterra-table1");
    EXPECT_THAT(to_c_header(model), testing::Not(testing::HasSubstr("mean power")));
    for (const auto phase : {flight::Phase::takeoff, flight::Phase::landing}) {
        model.phases[phase].power.by = mechanical::PowerBasis::mean;
        model.phases[phase].fourier.cos_w = model.phases[phase].fourier.sin_w = {};
    }
    EXPECT_THAT(to_c_header(model),
                testing::HasSubstr(" * Of the flights' mean power, not of a series: takeoff, landing.\n"));
}

TEST(ModelJson, HoldsTheKeysOfTheFile) {
    const auto model = model_file("synthetic-wing");
    const auto json = nlohmann::json::parse(to_json_text(model));
    EXPECT_EQ(json.at("name"), "synthetic-wing");
    EXPECT_EQ(json.at("format"), 1);
    for (const auto phase : flight::all_phases) {
        const auto& entry = json.at(std::string(to_string(phase)));
        EXPECT_EQ(entry.at("duration_s").get<double>(), model.phases[phase].duration_s);
        EXPECT_EQ(entry.at("a0_w").get<double>(), model.phases[phase].fourier.a0_w);
        EXPECT_EQ(entry.at("cos_w").get<std::vector<double>>(), model.phases[phase].fourier.cos_w);
    }
    EXPECT_EQ(json.at("physical").at("terms").at(0).at("coefficient").get<double>(), 0.0095);
}

TEST(ModelJson, HoldsABattery) {
    const auto pack = battery::read_battery(test::source_dir() / "fits" / "battery" / "synthetic-3s.toml");
    const auto json = nlohmann::json::parse(to_json_text(pack));
    EXPECT_EQ(json.at("capacity_ah").get<double>(), pack.capacity_ah);
    EXPECT_EQ(json.at("open_circuit").at("voltage_v").get<std::vector<double>>(),
              pack.thevenin->open_circuit.voltage_v);
}

}  // namespace
}  // namespace flightwatt::exchange
