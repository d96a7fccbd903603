// Batteries of simulators: names as documented, numbers against the simulators' own equations.

#include "exchange/simulator_parameters.h"

#include "base/error.h"
#include "base/number.h"
#include "battery/discharge.h"
#include "exchange/autopilot_parameters.h"
#include "exchange/px4_parameters.h"
#include "helpers/synthetic_discharge.h"
#include "helpers/test_paths.h"

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

using Names = std::set<std::string>;

/// The known pack of three cells with 2.4 Ah, and the wing that no one built, 24 W in cruise; a computer of 6 W.
EstimatorInput simulated_aircraft() {
    EstimatorInput input;
    input.battery = test::known_pack();
    input.model = mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "synthetic-wing.toml");
    input.compute_w = 6.0;
    return input;
}

/// Numbers by name, of lines "WORD... NAME VALUE ..." with the name at a place.
std::map<std::string, double> numbers_of(const std::string& text, std::size_t name_at) {
    std::map<std::string, double> numbers;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        const std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
        numbers[all.at(name_at)] = number_or_nan(all.at(name_at + 1));
    }
    return numbers;
}

Names names_of(const std::map<std::string, double>& numbers) {
    Names names;
    for (const auto& [name, value] : numbers) names.insert(name);
    return names;
}

/// The first number in front of "mV" of the note on the open-circuit voltage, and that of the second [V].
std::pair<double, double> stated_errors_v(const ParameterText& exported) {
    std::smatch match;
    const auto notes = testing::PrintToString(exported.notes);
    EXPECT_TRUE(std::regex_search(notes, match, std::regex("up to (\\d+) mV off .*up to (\\d+) mV below"))) << notes;
    return {number_or_nan(match[1].str()) / 1000.0, number_or_nan(match[2].str()) / 1000.0};
}

/// The charge [%] of a pack under a power for 1 s more, by steps of 1 s with the RC pair settled.
double drained_percent(const battery::Battery& pack, double soc_percent, double power_w) {
    const double ohm = pack.resistance_ohm + pack.thevenin->rc_resistance_ohm;
    const double open_v = open_circuit_voltage_v(pack, soc_percent);
    const double current_a = (open_v - std::sqrt(open_v * open_v - 4.0 * ohm * power_w)) / (2.0 * ohm);
    return soc_percent - 100.0 * current_a / (3600.0 * pack.capacity_ah);
}

TEST(ArdupilotSitl, HasNamesAndUnitsOfSitlCpp) {
    const auto input = simulated_aircraft();
    const auto exported = to_ardupilot_sitl(input);
    const auto numbers = numbers_of(exported.text, 0);
    // libraries/SITL/SITL.cpp: BATT_VOLTAGE [V], BATT_CAP_AH [Ah]; AP_BattMonitor_Params.cpp: CAPACITY [mAh]
    EXPECT_EQ(names_of(numbers), (Names{"SIM_BATT_VOLTAGE", "SIM_BATT_CAP_AH", "BATT_CAPACITY"}));
    EXPECT_NEAR(numbers.at("SIM_BATT_VOLTAGE"), open_circuit_voltage_v(*input.battery, 100.0), 1e-4);
    EXPECT_EQ(numbers.at("SIM_BATT_CAP_AH"), 2.4);
    EXPECT_EQ(numbers.at("BATT_CAPACITY"), 2400.0);
    EXPECT_EQ(exported.notes.size(), 4U);
}

TEST(ArdupilotSitl, HasTheRestAsKeysOfAFrame) {
    auto input = simulated_aircraft();
    const auto frame_of = [&] {
        std::map<std::string, double> keys;
        const auto text = to_ardupilot_sitl(input).text;
        const std::regex pair("\"(\\w+)\": ([0-9.e-]+)");
        for (auto at = std::sregex_iterator(text.begin(), text.end(), pair); at != std::sregex_iterator(); ++at)
            keys[(*at)[1]] = number_or_nan((*at)[2].str());
        return keys;
    };
    const auto frame = frame_of();
    // libraries/SITL/SIM_Frame.cpp, load_frame_params
    EXPECT_EQ(names_of(frame), (Names{"maxVoltage", "battCapacityAh", "refBatRes", "refVoltage", "refCurrent"}));
    EXPECT_NEAR(frame.at("refBatRes"), 0.13, 1e-6);
    EXPECT_NEAR(frame.at("refVoltage") * frame.at("refCurrent"), 30.0, 1e-3) << "the power in hover";
    EXPECT_NEAR(frame.at("refVoltage"), open_circuit_voltage_v(*input.battery, 50.0) - 0.13 * frame.at("refCurrent"),
                1e-4);
    input.model.reset();
    EXPECT_EQ(frame_of().size(), 3U);
    input.battery.reset();
    EXPECT_THROW(to_ardupilot_sitl(input), InputError);
}

TEST(Px4Sitl, HasNamesAndRangesOfItsSimulator) {
    const auto exported = to_px4_sitl(simulated_aircraft());
    const auto numbers = numbers_of(exported.text, 2);
    // battery_simulator_params.c: SIM_BAT_ENABLE, SIM_BAT_DRAIN [s] 1 to 86400, SIM_BAT_MIN_PCT [%] 0 to 100;
    // src/lib/battery/module.yaml: the others
    EXPECT_EQ(names_of(numbers), (Names{"SIM_BAT_ENABLE", "SIM_BAT_DRAIN", "SIM_BAT_MIN_PCT", "BAT1_N_CELLS",
                                        "BAT1_V_EMPTY", "BAT1_V_CHARGED"}));
    EXPECT_EQ(numbers.at("SIM_BAT_ENABLE"), 1.0);
    EXPECT_EQ(numbers.at("SIM_BAT_MIN_PCT"), 0.0);
    EXPECT_EQ(numbers.at("BAT1_N_CELLS"), 3.0);
    EXPECT_THAT(exported.text, testing::HasSubstr("SIM_BAT_ENABLE\t1\t6\n")) << "INT32 of MAVLink";
    EXPECT_EQ(exported.notes.size(), 4U);
}

TEST(Px4Sitl, DrainsAsLongAsThePackLasts) {
    const auto input = simulated_aircraft();
    double time_s = 0.0;
    for (double soc_percent = 100.0; soc_percent > 0.0; time_s += 1.0)
        soc_percent = drained_percent(*input.battery, soc_percent, 30.0);
    EXPECT_NEAR(numbers_of(to_px4_sitl(input).text, 2).at("SIM_BAT_DRAIN"), time_s, 0.005 * time_s);
}

TEST(Px4Sitl, StatesHowFarItsLineIsFromTheCurve) {
    auto input = simulated_aircraft();
    for (const std::optional<double> reserve : {std::optional<double>(), std::optional(30.0)}) {
        input.reserve_percent = reserve;
        const double lowest = reserve.value_or(10.0);
        const auto exported = to_px4_sitl(input);
        const auto numbers = numbers_of(exported.text, 2);
        double above_v = 0.0;
        double below_v = 0.0;
        double sum_v = 0.0;
        for (double soc = 0.0; soc <= 100.0; soc += 0.05) {
            const double line_v =
                3.0 * std::lerp(numbers.at("BAT1_V_EMPTY"), numbers.at("BAT1_V_CHARGED"), soc / 100.0);
            const double off_v = line_v - open_circuit_voltage_v(*input.battery, soc);
            if (soc >= lowest) sum_v += off_v;
            auto& worst_v = soc >= lowest ? above_v : below_v;
            worst_v = std::max(worst_v, std::abs(off_v));
        }
        EXPECT_NEAR(sum_v * 0.05 / (100.0 - lowest), 0.0, 0.005) << "least squares: on average none";
        const auto [stated_v, stated_below_v] = stated_errors_v(exported);
        EXPECT_NEAR(stated_v, above_v, 0.002);
        EXPECT_NEAR(stated_below_v, below_v, 0.02);
    }
}

TEST(Px4Sitl, RefusesWhatItDoesNotTake) {
    auto input = simulated_aircraft();
    input.compute_w = 1e5;
    EXPECT_THROW(to_px4_sitl(input), NoResultError) << "beyond the power limit";
    input = simulated_aircraft();
    input.battery->capacity_ah = 100.0;
    EXPECT_THROW(to_px4_sitl(input), InputError) << "more than a day";
    input = simulated_aircraft();
    input.battery = battery::Battery{"ideal", 11.1, 0.03, 3.2};
    EXPECT_THROW(to_px4_sitl(input), InputError) << "no voltage that shows the charge";
    input = simulated_aircraft();
    input.model.reset();
    EXPECT_THROW(to_px4_sitl(input), InputError);
}

/// The elements of a plugin, and its text's validity.
std::map<std::string, std::string> elements_of(const std::string& text) {
    pugi::xml_document document;
    const auto parsed = document.load_string(text.c_str());
    EXPECT_TRUE(parsed) << parsed.description();
    const auto plugin = document.document_element();
    // SDF's plugin.sdf: the attributes filename (required) and name, and elements of the plugin
    EXPECT_STREQ(plugin.name(), "plugin");
    EXPECT_STREQ(plugin.attribute("filename").value(), "gz-sim-linearbatteryplugin-system");
    EXPECT_STREQ(plugin.attribute("name").value(), "gz::sim::systems::LinearBatteryPlugin");
    EXPECT_EQ(std::distance(plugin.attributes_begin(), plugin.attributes_end()), 2);
    std::map<std::string, std::string> elements;
    for (const auto& child : plugin) EXPECT_TRUE(elements.emplace(child.name(), child.text().get()).second);
    return elements;
}

TEST(Gazebo, IsAPluginWithDocumentedElements) {
    // LinearBatteryPlugin.hh, "System parameters"
    const Names documented{"battery_name",
                           "voltage",
                           "open_circuit_voltage_constant_coef",
                           "open_circuit_voltage_linear_coef",
                           "initial_charge",
                           "capacity",
                           "resistance",
                           "smooth_current_tau",
                           "power_load",
                           "enable_recharge",
                           "recharge_by_topic",
                           "charging_time",
                           "fix_issue_225",
                           "start_draining",
                           "power_draining_topic",
                           "stop_power_draining_topic"};
    auto input = simulated_aircraft();
    input.battery->name = "3S <2.4 Ah> & \"new\" -- spare";
    const auto elements = elements_of(to_gazebo(input).text);
    for (const auto& [name, value] : elements) EXPECT_TRUE(documented.contains(name)) << name;
    for (const auto* required : {"battery_name", "voltage", "power_load"})
        EXPECT_TRUE(elements.contains(required)) << required;
    EXPECT_EQ(elements.at("battery_name"), input.battery->name);
    EXPECT_EQ(elements.at("fix_issue_225"), "true");
    EXPECT_EQ(elements.at("initial_charge"), elements.at("capacity"));
    EXPECT_EQ(elements.at("voltage"), elements.at("open_circuit_voltage_constant_coef"));
    input.battery->name.clear();
    EXPECT_EQ(elements_of(to_gazebo(input).text).at("battery_name"), "battery") << "which is required";
}

TEST(Gazebo, DischargesAsOursWithinTheStatedDeviation) {
    const auto input = simulated_aircraft();
    const auto exported = to_gazebo(input);
    const auto elements = elements_of(exported.text);
    const auto number = [&](const char* name) { return number_or_nan(elements.at(name)); };
    // LinearBatteryPlugin::OnUpdateVoltage, the current without its low-pass
    double charge_ah = number("initial_charge");
    double voltage_v = number("voltage");
    double worst_v = 0.0;
    battery::Discharge ours{{100.0, 0.0}};
    constexpr double step_s = 5.0;
    constexpr double settled_s = 300.0;  // several time constants of the RC pair
    for (double time_s = 0.0; ours.soc_percent > 10.5; time_s += step_s) {
        ours = discharge(*input.battery, {[](double) { return 30.0; }, 0.0, step_s}, ours);
        for (int i = 0; i < 50; ++i) {
            const double current_a = number("power_load") / voltage_v;
            charge_ah -= current_a * 0.1 / 3600.0;
            voltage_v = number("open_circuit_voltage_constant_coef") +
                        number("open_circuit_voltage_linear_coef") * (1.0 - charge_ah / number("capacity")) -
                        number("resistance") * current_a;
        }
        EXPECT_NEAR(100.0 * charge_ah / 2.4, ours.soc_percent, 1.5) << time_s;
        if (time_s < settled_s) continue;
        const double ours_v = terminal_voltage_v(*input.battery, ours, internal_current_a(*input.battery, 30.0, ours));
        worst_v = std::max(worst_v, std::abs(voltage_v - ours_v));
    }
    const double stated_v = stated_errors_v(exported).first;
    EXPECT_LT(worst_v, 1.15 * stated_v);
    EXPECT_GT(worst_v, 0.4 * stated_v) << "the statement is not much too large";
}

TEST(Gazebo, HasAConstantVoltageToo) {
    auto input = simulated_aircraft();
    input.battery = battery::Battery{"ideal", 11.1, 0.03, 3.2};
    const auto elements = elements_of(to_gazebo(input).text);
    EXPECT_NEAR(number_or_nan(elements.at("open_circuit_voltage_linear_coef")), 0.0, 1e-9);
    EXPECT_NEAR(number_or_nan(elements.at("voltage")), 11.1, 1e-6);
    input.model.reset();
    EXPECT_THROW(to_gazebo(input), InputError) << "power_load is required";
}

}  // namespace
}  // namespace flightwatt::exchange
