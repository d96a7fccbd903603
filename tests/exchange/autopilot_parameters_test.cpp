// Parameters against what the autopilots make of them: their own formulas, as docs/exports.md has them.

#include "exchange/autopilot_parameters.h"

#include "base/error.h"
#include "base/number.h"
#include "exchange/monitor_parameters.h"
#include "exchange/px4_parameters.h"
#include "helpers/synthetic_discharge.h"
#include "helpers/test_paths.h"

#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::exchange {
namespace {

using flight::Phase;

/// The known pack of three cells with 2.4 Ah, and the wing that no one built; a computer of 6 W.
EstimatorInput known_input() {
    EstimatorInput input;
    input.battery = test::known_pack();
    input.model = mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "synthetic-wing.toml");
    input.compute_w = 6.0;
    return input;
}

/// Names and values of lines "WORD... NAME VALUE ..." with the name at a place.
std::map<std::string, std::string> values_of(const std::string& text, std::size_t name_at, std::size_t value_at) {
    std::map<std::string, std::string> values;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
        if (all.size() > std::max(name_at, value_at)) values[all[name_at]] = all[value_at];
    }
    return values;
}

std::map<std::string, double> px4_values(const EstimatorInput& input) {
    std::map<std::string, double> numbers;
    for (const auto& [name, value] : values_of(to_px4(input).text, 2, 3)) numbers[name] = number_or_nan(value);
    return numbers;
}

TEST(Px4, HasThePackACell) {
    const auto px4 = px4_values(known_input());
    EXPECT_EQ(px4.at("BAT1_N_CELLS"), 3.0);
    EXPECT_NEAR(px4.at("BAT1_CAPACITY"), 2400.0, 1e-6);
    EXPECT_NEAR(px4.at("BAT1_R_INTERNAL"), (0.08 + 0.05) / 3.0, 1e-8) << "both resistances, of a cell";
}

TEST(Px4, HasThePackOfEachMonitor) {
    const auto all = px4_values(known_input());
    auto input = known_input();
    input.battery->monitors = {{1, 0.6}, {2, 0.4}};
    const auto px4 = px4_values(input);
    EXPECT_NEAR(px4.at("BAT2_CAPACITY"), 0.4 * all.at("BAT1_CAPACITY"), 1e-6);
    EXPECT_NEAR(px4.at("BAT2_R_INTERNAL") * 0.4, all.at("BAT1_R_INTERNAL"), 1e-8) << "the same voltage falls";
    EXPECT_NEAR(px4.at("BAT_AVRG_CURRENT"), 0.6 * all.at("BAT_AVRG_CURRENT"), 1e-6) << "one value for all: the most";
    EXPECT_EQ(px4.at("BAT2_V_EMPTY"), all.at("BAT1_V_EMPTY"));
    input.battery->monitors = {{1, 0.0}, {2, 0.0}};
    const auto unknown = px4_values(input);
    EXPECT_FALSE(unknown.contains("BAT1_CAPACITY") || unknown.contains("BAT_AVRG_CURRENT"));
}

TEST(Px4, TellsTheChargeByItsOwnFormula) {
    const auto input = known_input();
    const auto px4 = px4_values(input);
    double sum_percent = 0.0;
    for (double soc = 10.0; soc <= 100.0; soc += 10.0) {
        // calculateStateOfChargeVoltageBased: what the terminals show plus current times resistance, linear.
        const double current_a = 5.0;
        const double rc_v = current_a * input.battery->thevenin->rc_resistance_ohm;
        const double cell_v = terminal_voltage_v(*input.battery, {soc, rc_v}, current_a) / 3.0;
        const double rest_v = cell_v + px4.at("BAT1_R_INTERNAL") * current_a;
        const double reported =
            100.0 * (rest_v - px4.at("BAT1_V_EMPTY")) / (px4.at("BAT1_V_CHARGED") - px4.at("BAT1_V_EMPTY"));
        EXPECT_NEAR(reported, soc, 20.0) << "a line through a curve";
        sum_percent += reported - soc;
    }
    EXPECT_NEAR(sum_percent / 10.0, 0.0, 3.0) << "on average";
}

TEST(Px4, HasTheCurrentThatDeliversTheCruise) {
    const auto input = known_input();
    const double current_a = px4_values(input).at("BAT_AVRG_CURRENT");
    const double rc_v = current_a * input.battery->thevenin->rc_resistance_ohm;
    EXPECT_NEAR(current_a * terminal_voltage_v(*input.battery, {50.0, rc_v}, current_a), 24.0 + 6.0, 1e-4);
}

TEST(Px4, LeavesOutWhatIsNotKnown) {
    EstimatorInput input;
    input.battery = battery::Battery{"ideal", 11.1, 0.03, 3.2};
    const auto px4 = px4_values(input);
    EXPECT_FALSE(px4.contains("BAT1_V_EMPTY"));
    EXPECT_FALSE(px4.contains("BAT_AVRG_CURRENT"));
    EXPECT_EQ(to_px4(input).notes.size(), 2U);
    input.battery.reset();
    EXPECT_THROW(to_px4(input), InputError);
    input = known_input();
    input.battery->resistance_ohm = 3.0;
    EXPECT_THROW(to_px4(input), InputError) << "PX4 takes up to 0.2 ohm a cell";
    input = known_input();
    input.cells_in_series = 4;
    EXPECT_EQ(px4_values(input).at("BAT1_N_CELLS"), 4.0);
}

TEST(Inav, HasPowersInHundredthsOfAWattAndTheEnergyInMilliwattHours) {
    auto input = known_input();
    input.reserve_percent = 20.0;
    const auto inav = values_of(to_inav(input).text, 1, 3);
    EXPECT_EQ(inav.at("bat_cells"), "3");
    EXPECT_EQ(inav.at("battery_capacity_unit"), "MWH");
    EXPECT_NEAR(number_or_nan(inav.at("battery_capacity")), 1000.0 * full_energy_wh(*input.battery), 0.51);
    EXPECT_EQ(inav.at("idle_power"), "600");
    EXPECT_EQ(inav.at("cruise_power"), "2400") << "what the motor takes in addition";
    EXPECT_EQ(inav.at("nav_fw_cruise_speed"), "1320");
    EXPECT_EQ(inav.at("rth_energy_margin"), "20");
}

TEST(Inav, SplitsTheCruiseAsItIsTold) {
    auto input = known_input();
    input.idle_w = 8.5;
    const auto inav = values_of(to_inav(input).text, 1, 3);
    EXPECT_EQ(inav.at("idle_power"), "850");
    EXPECT_EQ(inav.at("cruise_power"), "2150");
    input.idle_w = 30.0;
    EXPECT_THROW(to_inav(input), InputError) << "as much as the cruise";
    input = known_input();
    input.model->physical.reset();
    const auto without = to_inav(input);
    EXPECT_FALSE(values_of(without.text, 1, 3).contains("nav_fw_cruise_speed"));
    EXPECT_EQ(without.notes.size(), 2U);
    input.model.reset();
    EXPECT_THROW(to_inav(input), InputError);
}

/// The numbers between brackets, or of a constant, in Python's text.
std::vector<double> python_numbers(const std::string& text, const std::string& name) {
    auto at = text.find("\n" + name + " = ");
    EXPECT_NE(at, std::string::npos) << name;
    at += name.size() + 4;
    auto line = text.substr(at, text.find('\n', at) - at);
    line = line.substr(0, line.find('#'));
    for (char& c : line)
        if (c == '[' || c == ']' || c == ',') c = ' ';
    std::istringstream words(line);
    return {std::istream_iterator<double>(words), {}};
}

TEST(PaparazziMonitor, HasThePowerOfLevelFlight) {
    const auto input = known_input();
    const auto text = to_paparazzi(input).text;
    const auto c = python_numbers(text, "coeffs_power_from_airspeed");
    ASSERT_EQ(c.size(), 3U);
    for (double v = 11.0; v <= 17.0; v += 0.5) {
        // get_expected_power_from_airspeed
        EXPECT_NEAR(c[0] * v * v + c[1] * v + c[2], power_w(*input.model->physical, {v, 0.0, 1.0}) + 6.0, 0.3) << v;
    }
    EXPECT_EQ(python_numbers(text, "capacity"), std::vector{2400.0});
    EXPECT_EQ(python_numbers(text, "cells_in_series"), std::vector{3.0});
    EXPECT_NEAR(python_numbers(text, "energy_takeoff").at(0), 66.0 * 30.0 / 3600.0, 1e-3);
    EXPECT_NEAR(python_numbers(text, "energy_land").at(0), 15.0 * 50.0 / 3600.0, 1e-3);
    EXPECT_NEAR(python_numbers(text, "power_hover").at(0), 30.0, 1e-3);
    EXPECT_EQ(python_numbers(text, "expected_landing_time"), std::vector{50.0});
}

TEST(PaparazziMonitor, NeedsAModelOfAirspeed) {
    auto input = known_input();
    input.model->physical.reset();
    EXPECT_THROW(to_paparazzi(input), InputError);
}

std::vector<std::vector<double>> rows_of(const std::string& text) {
    std::vector<std::vector<double>> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        rows.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
    }
    return rows;
}

TEST(PaparazziMap, HasTheChargeWhereACellShowsAVoltageUnderACurrent) {
    auto input = known_input();
    input.cells_in_parallel = 2;
    const auto rows = rows_of(to_paparazzi_map(input).text);
    ASSERT_EQ(rows.size(), 171U);
    EXPECT_EQ(rows.front().at(0), 4.20);
    EXPECT_EQ(rows.back().at(0), 2.50);
    std::size_t seen = 0;
    for (const auto& row : rows) {
        ASSERT_EQ(row.size(), 6U);
        for (std::size_t i = 0; i < 5; ++i) {
            const double pack_a = 2.0 * static_cast<double>(i + 1) * input.cells_in_parallel;
            const double drawn_mah = row[i + 1];
            EXPECT_GE(drawn_mah, 0.0);
            EXPECT_LE(drawn_mah, 1200.0) << "half the pack";
            if (drawn_mah == 0.0 || drawn_mah == 1200.0) continue;
            ++seen;
            const double soc = 100.0 * (1.0 - drawn_mah / 1200.0);
            const double rc_v = pack_a * input.battery->thevenin->rc_resistance_ohm;
            EXPECT_NEAR(terminal_voltage_v(*input.battery, {soc, rc_v}, pack_a) / 3.0, row[0], 1e-6);
        }
    }
    EXPECT_GT(seen, 100U);
}

TEST(PaparazziMap, NeedsACurve) {
    EstimatorInput input;
    input.battery = battery::Battery{"ideal", 11.1, 0.03, 3.2};
    EXPECT_THROW(to_paparazzi_map(input), InputError);
}

}  // namespace
}  // namespace flightwatt::exchange
