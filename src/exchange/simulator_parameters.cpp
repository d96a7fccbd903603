#include "exchange/simulator_parameters.h"

#include "base/units.h"
#include "exchange/estimators/pack_summary.h"

#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::exchange {

ParameterText to_ardupilot_sitl(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, "ArduPilot's SITL");
    const double full_v = open_circuit_voltage_v(pack.battery, units::percent_per_whole);
    std::vector<std::string> limits{
        "the pack's open-circuit voltage: the simulator scales its own curve of a LiPo cell to SIM_BATT_VOLTAGE",
        "resistance and power: a multirotor's frame file (--model x:FRAME.json) has them, no parameter",
        resistance_limit};
    auto frame = fmt::format(R"("maxVoltage": {:.6g}, "battCapacityAh": {:.6g}, "refBatRes": {:.6g})", full_v,
                             pack.battery.capacity_ah, pack.battery.resistance_ohm);
    if (input.model) {
        limits.push_back(power_limit(input));
        const double current_a = cruise_current_a(input, pack);
        frame += fmt::format(R"(, "refVoltage": {:.6g}, "refCurrent": {:.6g})",
                             terminal_voltage_v(pack.battery, {half_charged_percent, 0.0}, current_a), current_a);
    }
    ParameterText result{"# Written by flightwatt export " FLIGHTWATT_VERSION ", for ArduPilot's SITL\n"};
    result.text += note_limits(limits, "# ", result);
    result.text +=
        fmt::format("# For FRAME.json: {}\nSIM_BATT_VOLTAGE {:.6g}\nSIM_BATT_CAP_AH {:.6g}\nBATT_CAPACITY {:.0f}\n",
                    frame, full_v, pack.battery.capacity_ah, pack.capacity_mah);
    return result;
}

ParameterText to_gazebo(const EstimatorInput& input) {
    constexpr auto gazebo = "Gazebo's LinearBatteryPlugin";
    const auto pack = summarize_pack(input, gazebo);
    required_model(input, gazebo);
    const auto line = fit_voltage_line(pack.battery, pack.lowest_percent);
    ParameterText result;
    const auto comment = "\nWritten by flightwatt export " FLIGHTWATT_VERSION ", for a <model>\n" +
                         note_limits({voltage_limit(line), resistance_limit, power_limit(input)}, "", result);
    pugi::xml_document xml;
    xml.append_child(pugi::node_comment).set_value(comment.c_str());
    auto plugin = xml.append_child("plugin");
    plugin.append_attribute("filename") = "gz-sim-linearbatteryplugin-system";
    plugin.append_attribute("name") = "gz::sim::systems::LinearBatteryPlugin";
    const auto add = [&](const char* name, const std::string& value) {
        plugin.append_child(name).text().set(value.c_str());
    };
    const auto& battery = pack.battery;
    add("battery_name", battery.name.empty() ? "battery" : battery.name);
    for (const auto& [name, value] : {std::pair{"voltage", line.full_v},
                                      {"open_circuit_voltage_constant_coef", line.full_v},
                                      {"open_circuit_voltage_linear_coef", line.empty_v - line.full_v},
                                      {"initial_charge", battery.capacity_ah},
                                      {"capacity", battery.capacity_ah},
                                      {"resistance", battery.resistance_ohm},
                                      {"power_load", mean_power_w(input, flight::Phase::cruise)}})
        add(name, fmt::format("{:.9g}", value));
    add("fix_issue_225", "true");
    std::ostringstream text;
    xml.save(text, "  ", pugi::format_indent | pugi::format_no_declaration);
    result.text = std::move(text).str();
    return result;
}

}  // namespace flightwatt::exchange
