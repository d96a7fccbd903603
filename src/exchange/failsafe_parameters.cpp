#include "exchange/failsafe_parameters.h"

#include "base/error.h"
#include "base/units.h"
#include "exchange/estimators/pack_summary.h"
#include "exchange/estimators/px4_lines.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

using answer::FailsafeAction;
using answer::FailsafeCard;

std::string card_comment(const FailsafeCard& card, const std::string& prefix) {
    std::string text;
    std::istringstream lines(describe(card));
    for (std::string line; std::getline(lines, line);) text += prefix + line + "\n";
    return text;
}

std::string head(const std::string& reader) {
    return fmt::format("# Written by flightwatt export " FLIGHTWATT_VERSION ", for {}\n", reader);
}

/// The notes of omitted parameters.
void note_omitted(const FailsafeCard& card, const std::string& of_low, const std::string& of_voltages,
                  ParameterText& result) {
    if (!card.low) result.notes.push_back(fmt::format("{}: {} omitted", card.low_missing, of_low));
    if (!card.critical.voltage && !of_voltages.empty())
        result.notes.push_back(fmt::format("the battery has a constant voltage: {} are omitted", of_voltages));
}

/// A threshold of PX4 with its documented range.
struct Px4Threshold {
    const char* name;
    double least;
    double most;
};
constexpr Px4Threshold px4_low{"BAT_LOW_THR", 0.12, 0.5};
constexpr Px4Threshold px4_critical{"BAT_CRIT_THR", 0.05, 0.25};
constexpr Px4Threshold px4_emergency{"BAT_EMERGEN_THR", 0.03, 0.1};

/// Adds the line of a threshold, raised into its range; returns the value.
double add_threshold(const Px4Threshold& threshold, double value, ParameterText& result) {
    value = std::max(value, threshold.least);
    result.text += px4_line(threshold.name, value);
    if (value > threshold.most)
        result.notes.push_back(
            fmt::format("{} = {:g} is above the {:g} of PX4's document, and a ground station may ask to confirm it; "
                        "less would be too late",
                        threshold.name, value, threshold.most));
    return value;
}

/// Of a cell [0.01 V], rounded up.
int cell_cv(double voltage_v, int cells) {
    constexpr double cv_per_v = 100.0;
    constexpr int min_cv = 100;
    constexpr int max_cv = 500;
    const auto value = static_cast<int>(std::ceil(voltage_v / cells * cv_per_v - 1e-9));
    if (value >= min_cv && value <= max_cv) return value;
    throw InputError(
        {}, fmt::format("the voltage of a cell would be {} in 0.01 V: INAV takes {} to {}", value, min_cv, max_cv),
        "is the number of cells right (--cells)?");
}

}  // namespace

ParameterText to_failsafe_ardupilot(const EstimatorInput& input, const FailsafeCard& card) {
    ParameterText result{head("ArduPilot") + card_comment(card, "# ")};
    const auto monitors = noted_monitors(input, result);
    const bool are_counted = monitors.front().part > 0.0;
    result.text +=
        "# To act: BATT_FS_LOW_ACT 1 (plane) or 2 (copter) returns, BATT_FS_CRT_ACT 2 (plane) or 1 (copter) lands\n";
    for (const auto& monitor : monitors) {
        const auto prefix = monitor.number == 1 ? std::string("BATT") : fmt::format("BATT{}", monitor.number);
        if (are_counted) result.text += fmt::format("{}_CAPACITY {:.0f}\n", prefix, monitor.part * card.capacity_mah);
        result.text += fmt::format("{}_FS_VOLTSRC 0\n", prefix);
        const auto add = [&](const FailsafeAction& action, const char* name) {
            const auto& voltage = are_counted ? action.voltage : action.voltage_alone;
            if (are_counted)
                result.text +=
                    fmt::format("{}_{}_MAH {:.0f}\n", prefix, name, std::ceil(monitor.part * action.remaining_mah));
            if (voltage) result.text += fmt::format("{}_{}_VOLT {:.2f}\n", prefix, name, voltage->voltage_v);
        };
        if (card.low) add(*card.low, "LOW");
        add(card.critical, "CRT");
    }
    note_omitted(card, "BATT_LOW_MAH and BATT_LOW_VOLT are", "BATT_LOW_VOLT and BATT_CRT_VOLT", result);
    return result;
}

ParameterText to_failsafe_px4(const EstimatorInput& input, const FailsafeCard& card) {
    constexpr double warning = 0.05;
    constexpr double step = 0.01;
    ParameterText result{px4_head("PX4") + card_comment(card, "# ")};
    const auto monitors = noted_monitors(input, result);
    if (monitors.front().part == 0.0) return result;
    result.text += "# To act: COM_LOW_BAT_ACT 3 returns at BAT_CRIT_THR and lands at BAT_EMERGEN_THR\n";
    for (const auto& monitor : monitors)
        result.text += px4_line(fmt::format("BAT{}_CAPACITY", monitor.number), monitor.part * card.capacity_mah);
    const double land = add_threshold(px4_emergency, card.critical.soc_percent / units::percent_per_whole, result);
    if (card.low) {
        const double back = add_threshold(
            px4_critical, std::max(card.low->soc_percent / units::percent_per_whole, land + step), result);
        add_threshold(px4_low, std::min(1.0, back + warning), result);
    }
    note_omitted(card, "BAT_LOW_THR and BAT_CRIT_THR, which have to be above BAT_EMERGEN_THR, are", "", result);
    return result;
}

ParameterText to_failsafe_inav(const EstimatorInput& input, const FailsafeCard& card) {
    const auto cells = summarize_pack(input, "INAV").cells;
    ParameterText result{
        head("INAV's CLI; then: save") + card_comment(card, "# ") +
        "# INAV sounds alarms at these values; it does not return by them. Its own estimator (the format "
        "inav) needs mWh.\n"};
    const auto set = [&](const char* name, auto value) { result.text += fmt::format("set {} = {}\n", name, value); };
    set("battery_capacity_unit", "MAH");
    set("battery_capacity", std::lround(card.capacity_mah));
    if (card.low) set("battery_capacity_warning", card.low->remaining_mah);
    set("battery_capacity_critical", card.critical.remaining_mah);
    if (card.low && card.low->voltage) set("vbat_warning_cell_voltage", cell_cv(card.low->voltage->voltage_v, cells));
    if (card.critical.voltage) set("vbat_min_cell_voltage", cell_cv(card.critical.voltage->voltage_v, cells));
    note_omitted(card, "battery_capacity_warning and vbat_warning_cell_voltage are",
                 "vbat_warning_cell_voltage and vbat_min_cell_voltage", result);
    return result;
}

ParameterText to_failsafe_paparazzi(const EstimatorInput& /*input*/, const FailsafeCard& card) {
    constexpr double step_v = 0.1;
    constexpr double exact = 1e-9;
    if (!card.critical.voltage_alone || !card.empty_voltage_v)
        throw InputError({},
                         "the voltage of this battery does not depend on its state of charge, as Paparazzi requires",
                         "identify the open-circuit voltage with flightwatt battery");
    ParameterText result;
    const auto comment = "\nWritten by flightwatt export " FLIGHTWATT_VERSION
                         ", for the airframe of Paparazzi: voltages without a count of charge\n" +
                         card_comment(card, "") +
                         "Below CATASTROPHIC_BAT_LEVEL for 5 s a fixed wing stops its motor: the empty pack, rounded "
                         "down.\n";
    pugi::xml_document xml;
    xml.append_child(pugi::node_comment).set_value(comment.c_str());
    auto section = xml.append_child("section");
    section.append_attribute("name") = "BAT";
    const auto define = [&](const char* name, double steps) {
        auto element = section.append_child("define");
        element.append_attribute("name") = name;
        element.append_attribute("value") = fmt::format("{:.1f}", steps * step_v).c_str();
        element.append_attribute("unit") = "V";
    };
    const auto up = [&](double voltage_v) { return std::ceil(voltage_v / step_v - exact); };
    const double critical = up(card.critical.voltage_alone->voltage_v);
    if (card.low && card.low->voltage_alone)
        define("LOW_BAT_LEVEL", std::max(critical, up(card.low->voltage_alone->voltage_v)));
    define("CRITIC_BAT_LEVEL", critical);
    define("CATASTROPHIC_BAT_LEVEL", std::min(critical - 1.0, std::floor(*card.empty_voltage_v / step_v + exact)));
    std::ostringstream text;
    xml.save(text, "  ", pugi::format_default | pugi::format_no_declaration);
    result.text = text.str();
    note_omitted(card, "LOW_BAT_LEVEL is", "", result);
    return result;
}

}  // namespace flightwatt::exchange
