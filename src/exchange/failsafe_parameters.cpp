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

/// A value of the low action as its format states it.
struct LowValue {
    double value = 0.0;
    std::string comment = {};  ///< that it was raised; may be empty
};

/// Returns the value, raised to a step above the critical action's: of two equal ones the aircraft would land before it
/// returns, and ArduPilot does not arm.
LowValue above_critical(double low, double critical, double step, const std::string& low_name,
                        const std::string& critical_name) {
    constexpr double part_of_step = 1e-6;  // the error of a sum
    const double least = critical + step;
    if (low >= least - part_of_step * step) return {low};
    return {least, fmt::format("{} is raised to a step above {}, so that the low action comes first", low_name,
                               critical_name)};
}

std::string comment_line(const LowValue& low) { return low.comment.empty() ? "" : "# " + low.comment + "\n"; }

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

/// The lines of both actions of a battery monitor, by its part of the charge; 0: it is not known.
std::string ardupilot_actions(const FailsafeCard& card, const std::string& prefix, double part) {
    std::string low_text;
    std::string critical_text;
    const auto add = [&](const std::string& unit, double step, int decimals, const auto& value_of) {
        const auto low_name = fmt::format("{}_LOW_{}", prefix, unit);
        const auto critical_name = fmt::format("{}_CRT_{}", prefix, unit);
        const std::optional<double> low = card.low ? value_of(*card.low) : std::nullopt;
        const std::optional<double> critical = value_of(card.critical);
        if (low) {
            const auto value = above_critical(*low, critical.value_or(0.0), step, low_name, critical_name);
            low_text += comment_line(value) + fmt::format("{} {:.{}f}\n", low_name, value.value, decimals);
        }
        if (critical) critical_text += fmt::format("{} {:.{}f}\n", critical_name, *critical, decimals);
    };
    const bool is_counted = part > 0.0;
    if (is_counted)
        add("MAH", 1.0, 0,
            [&](const FailsafeAction& action) { return std::optional(std::ceil(part * action.remaining_mah)); });
    add("VOLT", 0.01, 2, [&](const FailsafeAction& action) {
        const auto& voltage = is_counted ? action.voltage : action.voltage_alone;
        return voltage ? std::optional(voltage->voltage_v) : std::nullopt;
    });
    return low_text + critical_text;
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
        result.text += ardupilot_actions(card, prefix, monitor.part);
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
        const auto low = above_critical(std::max(card.low->soc_percent / units::percent_per_whole, px4_critical.least),
                                        land, step, px4_critical.name, px4_emergency.name);
        result.text += comment_line(low);
        const double back = add_threshold(px4_critical, low.value, result);
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
    const auto set_low = [&](const char* name, double low, const char* critical_name, double critical) {
        const auto value = above_critical(low, critical, 1.0, name, critical_name);
        result.text += comment_line(value);
        set(name, std::lround(value.value));
    };
    const auto& critical_v = card.critical.voltage;
    if (card.low)
        set_low("battery_capacity_warning", card.low->remaining_mah, "battery_capacity_critical",
                card.critical.remaining_mah);
    set("battery_capacity_critical", card.critical.remaining_mah);
    const int critical_cv = critical_v ? cell_cv(critical_v->voltage_v, cells) : 0;
    if (card.low && card.low->voltage)
        set_low("vbat_warning_cell_voltage", cell_cv(card.low->voltage->voltage_v, cells), "vbat_min_cell_voltage",
                critical_cv);
    if (critical_v) set("vbat_min_cell_voltage", critical_cv);
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
    if (card.low && card.low->voltage_alone) {
        const auto low = above_critical(up(card.low->voltage_alone->voltage_v) * step_v, critical * step_v, step_v,
                                        "LOW_BAT_LEVEL", "CRITIC_BAT_LEVEL");
        if (!low.comment.empty())
            section.append_child(pugi::node_comment).set_value(fmt::format(" {} ", low.comment).c_str());
        define("LOW_BAT_LEVEL", low.value / step_v);
    }
    define("CRITIC_BAT_LEVEL", critical);
    define("CATASTROPHIC_BAT_LEVEL", std::min(critical - 1.0, std::floor(*card.empty_voltage_v / step_v + exact)));
    std::ostringstream text;
    xml.save(text, "  ", pugi::format_default | pugi::format_no_declaration);
    result.text = text.str();
    note_omitted(card, "LOW_BAT_LEVEL is", "", result);
    return result;
}

}  // namespace flightwatt::exchange
