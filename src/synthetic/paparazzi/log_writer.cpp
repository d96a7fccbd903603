#include "synthetic/paparazzi/log_writer.h"

#include "base/text.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

namespace flightwatt::synthetic {
namespace {

void add_message(pugi::xml_node& parent, const telemetry::MessageDefinition& definition, int id) {
    auto message = parent.append_child("message");
    message.append_attribute("NAME") = definition.name.c_str();
    message.append_attribute("ID") = id;
    for (const auto& field : definition.fields) {
        auto node = message.append_child("field");
        if (!field.unit.empty()) node.append_attribute("UNIT") = field.unit.c_str();
        node.append_attribute("TYPE") = field.type.c_str();
        node.append_attribute("NAME") = field.name.c_str();
    }
}

void add_aircraft(pugi::xml_node& conf, const telemetry::AircraftConfiguration& aircraft) {
    auto node = conf.append_child("aircraft");
    node.append_attribute("name") = aircraft.name.c_str();
    node.append_attribute("ac_id") = aircraft.id.c_str();
    auto plan = node.append_child("flight_plan");
    plan.append_attribute("name") = "Survey";
    if (aircraft.ground_altitude_m) {
        plan.append_attribute("ground_alt") = fmt::format("{:g}", *aircraft.ground_altitude_m).c_str();
    }
    auto blocks = plan.append_child("blocks");
    for (const auto& [number, name] : aircraft.block_names) {
        auto block = blocks.append_child("block");
        block.append_attribute("name") = name.c_str();
        block.append_attribute("no") = number;
    }
    auto section = node.append_child("airframe").append_child("section");
    section.append_attribute("NAME") = "BAT";
    if (aircraft.current_origin == telemetry::CurrentOrigin::sensor) {
        auto define = section.append_child("define");
        define.append_attribute("VALUE") = "(_adc-632)*4.14";
        define.append_attribute("NAME") = "MilliAmpereOfAdc(_adc)";
    }
}

constexpr double reference_east_m = 588000.0;
constexpr double reference_north_m = 6148000.0;

std::string whole(double value) { return fmt::format("{}", std::llround(value)); }
std::string tenths(double value) { return ocaml_float(std::round(value * 10.0) / 10.0); }
std::string hundredths(double value) { return ocaml_float(std::round(value * 100.0) / 100.0); }

/// Number of the message modulo `count`.
int turn_of(const SensorReadings& m, double period_s, int count) {
    return static_cast<int>(m.time_s / period_s) % count;
}
int channel_of(const SensorReadings& m) { return turn_of(m, 0.6, 12); }
int waypoint_of(const SensorReadings& m) { return turn_of(m, 1.2, 10); }

/// A field as Paparazzi writes it.
struct NamedValue {
    std::string_view name;
    std::string (*text)(const SensorReadings& m);
};

constexpr NamedValue named_values[] = {
    {"throttle_percent", [](const SensorReadings& m) { return whole(m.state.throttle_percent); }},
    {"voltage_v", [](const SensorReadings& m) { return ocaml_float(m.voltage_v); }},
    {"current_a", [](const SensorReadings& m) { return ocaml_float(m.current_a); }},
    {"power_w", [](const SensorReadings& m) { return ocaml_float(m.voltage_v * m.current_a); }},
    {"charge_ah", [](const SensorReadings& m) { return ocaml_float(m.charge_ah); }},
    {"energy_wh", [](const SensorReadings& m) { return ocaml_float(m.energy_wh); }},
    {"altitude_m", [](const SensorReadings& m) { return ocaml_float(m.altitude_m); }},
    {"altitude_mm", [](const SensorReadings& m) { return whole(m.altitude_m * 1000.0); }},
    {"true_altitude_m", [](const SensorReadings& m) { return whole(m.state.altitude_m); }},
    {"climb_m_per_s", [](const SensorReadings& m) { return hundredths(m.state.climb_m_per_s); }},
    {"climb_cm_per_s", [](const SensorReadings& m) { return whole(m.state.climb_m_per_s * 100.0); }},
    {"pitch_rad", [](const SensorReadings& m) { return ocaml_float(m.state.climb_m_per_s / 20.0); }},
    {"block", [](const SensorReadings& m) { return std::to_string(m.state.block); }},
    {"east_m", [](const SensorReadings& m) { return whole(m.state.east_m); }},
    {"north_m", [](const SensorReadings& m) { return whole(m.state.north_m); }},
    {"east_tenths", [](const SensorReadings& m) { return tenths(m.state.east_m); }},
    {"north_tenths", [](const SensorReadings& m) { return tenths(m.state.north_m); }},
    {"utm_east_cm", [](const SensorReadings& m) { return whole((reference_east_m + m.state.east_m) * 100.0); }},
    {"utm_north_cm", [](const SensorReadings& m) { return whole((reference_north_m + m.state.north_m) * 100.0); }},
    {"home_tenths", [](const SensorReadings& m) { return tenths(std::hypot(m.state.east_m, m.state.north_m)); }},
    {"flight_time_s", [](const SensorReadings& m) { return whole(m.flight_time_s); }},
    {"motor_off", [](const SensorReadings& m) { return std::string(m.state.power_w > 0.0 ? "0" : "1"); }},
    {"mode", [](const SensorReadings& m) { return std::to_string(m.state.mode); }},
    {"automatic", [](const SensorReadings& m) { return std::string(m.state.mode == 2 ? "3" : "0"); }},
    {"roll_rad", [](const SensorReadings& m) { return ocaml_float(m.state.airborne ? -0.21 : 0.0); }},
    {"wanted_roll_rad", [](const SensorReadings& m) { return ocaml_float(m.state.airborne ? -0.2 : 0.0); }},
    {"turn_rad_per_s", [](const SensorReadings& m) { return ocaml_float(m.state.airborne ? -0.16 : 0.0); }},
    {"heading_rad",
     [](const SensorReadings& m) { return ocaml_float(std::remainder(m.state.course_rad, 2.0 * std::numbers::pi)); }},
    {"course_rad", [](const SensorReadings& m) { return hundredths(m.state.course_rad); }},
    {"course_decideg", [](const SensorReadings& m) { return whole(m.state.course_rad * 1800.0 / std::numbers::pi); }},
    {"speed_cm_per_s", [](const SensorReadings& m) { return whole(m.state.ground_speed_m_per_s * 100.0); }},
    {"airspeed",
     [](const SensorReadings& m) { return ocaml_float(m.state.airborne ? m.state.airspeed_m_per_s : 0.0); }},
    {"wind_east", [](const SensorReadings& m) { return hundredths(m.state.wind_east_m_per_s); }},
    {"wind_north", [](const SensorReadings& m) { return hundredths(m.state.wind_north_m_per_s); }},
    {"week_ms", [](const SensorReadings& m) { return whole(378000000.0 + m.time_s * 1000.0); }},
    {"channel", [](const SensorReadings& m) { return std::to_string(channel_of(m)); }},
    {"satellite", [](const SensorReadings& m) { return std::to_string(channel_of(m) + 3); }},
    {"elevation", [](const SensorReadings& m) { return std::to_string(7 * channel_of(m)); }},
    {"azimuth", [](const SensorReadings& m) { return std::to_string(29 * channel_of(m)); }},
    {"waypoint", [](const SensorReadings& m) { return std::to_string(waypoint_of(m)); }},
    {"waypoint_east", [](const SensorReadings& m) { return ocaml_float(reference_east_m + 20.5 * waypoint_of(m)); }},
    {"waypoint_north", [](const SensorReadings& m) { return ocaml_float(reference_north_m + 13.25 * waypoint_of(m)); }},
    {"commands",
     [](const SensorReadings& m) {
         return fmt::format("{:.0f},-240,1030", units::pprz_from_percent(m.state.throttle_percent));
     }},
    {"logged_bytes", [](const SensorReadings& m) { return whole(m.time_s * 512.0); }},
    {"log_file", [](const SensorReadings&) { return std::string(", FLIGHT_RECORDER\\fr_0001.LOG"); }},
};

/// A message: its fields as "name:type:unit" or "name:type", and their values: names of named_values, or literals.
struct MessageRow {
    double period_s;
    const char* name;
    const char* fields;
    const char* values;
};

constexpr MessageRow message_rows[] = {
    // Required for power and phases.
    {1.1, "ENERGY", "throttle:uint8:% voltage:float:V current:float:A power:float:W charge:float:Ah energy:float:Wh",
     "throttle_percent voltage_v current_a power_w charge_ah energy_wh"},
    {0.5, "ESTIMATOR", "z:float:m z_dot:float:m/s", "altitude_m climb_m_per_s"},
    {0.5, "NAVIGATION",
     "cur_block:uint8 cur_stage:uint8 pos_x:float:m pos_y:float:m dist_wp:float:m dist_home:float:m "
     "flight_time:uint16:s block_time:uint16:s stage_time:uint16:s kill_auto_throttle:uint8:bool "
     "circle_count:uint8 oval_count:uint8",
     "block 0 east_tenths north_tenths 0. home_tenths flight_time_s 0 0 motor_off 0 0"},
    {5.0, "PPRZ_MODE",
     "ap_mode:uint8 ap_gaz:uint8 ap_lateral:uint8 ap_horizontal:uint8 if_calib_mode:uint8 mcu1_status:uint8",
     "mode automatic automatic 2 0 17"},
    // Other typical messages.
    {0.15, "ATTITUDE", "phi:float:rad psi:float:rad theta:float:rad", "roll_rad heading_rad pitch_rad"},
    {0.5, "GPS",
     "mode:uint8:byte_mask utm_east:int32:cm utm_north:int32:cm course:int16:decideg alt:int32:mm "
     "speed:uint16:cm/s climb:int16:cm/s week:uint16:weeks itow:uint32:ms utm_zone:uint8 gps_nb_err:uint8",
     "3 utm_east_cm utm_north_cm course_decideg altitude_mm speed_cm_per_s climb_cm_per_s 2112 week_ms 32 0"},
    {0.3, "DESIRED",
     "roll:float:rad pitch:float:rad course:float:rad x:float:m y:float:m altitude:float:m climb:float:m/s "
     "airspeed:float:m/s",
     "wanted_roll_rad 0.05 course_rad east_m north_m true_altitude_m climb_m_per_s 13."},
    {0.6, "SVINFO", "chn:uint8 SVID:uint8 Flags:uint8 QI:uint8 CNO:uint8:dbHz Elev:int8:deg Azim:int16:deg",
     "channel satellite 13 7 36 elevation azimuth"},
    // No AIRSPEED: the synthetic power does not depend on it.
    {0.9, "IMU_GYRO", "gp:float:rad/s gq:float:rad/s gr:float:rad/s", "0. 0. turn_rad_per_s"},
    {1.2, "WP_MOVED", "wp_id:uint8 utm_east:float:m utm_north:float:m alt:float:m utm_zone:uint8",
     "waypoint waypoint_east waypoint_north 105. 32"},
    {5.0, "COMMANDS", "values:int16[]:ticks", "commands"},
    {10.0, "WIND_INFO", "ac_id:uint8 flags:uint8 east:float:m/s north:float:m/s up:float:m/s airspeed:float:m/s",
     "7 5 wind_east wind_north 0. airspeed"},
    {2.0, "FBW_STATUS", "rc_status:uint8 frame_rate:uint8:Hz mode:uint8 vsupply:float:V current:float:A",
     "0 61 0 voltage_v current_a"},
    {5.1, "ALIVE", "md5sum:uint8[]", "104,72,204,189,120,93,193,159,136,145,150,137,96,217,124,229"},
    {5.0, "PONG", "", ""},
    {7.1, "LOGGER_STATUS", "status:uint8 errno:uint8 used:uint32 logfile:char[]", "1 0 logged_bytes log_file"},
};

PeriodicMessage report_of(const MessageRow& row) {
    telemetry::MessageDefinition definition{row.name, {}, ".log"};
    for (const auto& field : split(row.fields, " ")) {
        const auto parts = split(field, ":");
        definition.fields.push_back({parts[0], parts[1], parts.size() > 2 ? parts[2] : "", "", {}});
    }
    const auto fields = [words = split(row.values, " ")](const SensorReadings& moment) {
        std::vector<std::string> values(words.size());
        std::ranges::transform(words, values.begin(), [&](const std::string& word) {
            const auto* named = std::ranges::find(named_values, word, &NamedValue::name);
            return named == std::end(named_values) ? word : named->text(moment);
        });
        return values;
    };
    return {row.period_s, std::move(definition), fields};
}

}  // namespace

std::string ocaml_float(double value) {
    const double sent = std::round(value * 1e6) / 1e6;
    auto text = fmt::format("{:.12g}", sent);
    if (text.find_first_of(".en") == std::string::npos) text += '.';
    return text;
}

std::string data_line(double time_s, std::string_view sender, std::string_view message,
                      const std::vector<std::string>& fields) {
    return fmt::format("{:.3f} {} {} {}\n", time_s, sender, message, fmt::join(fields, " "));
}

std::string to_log_xml(const std::string& comment, const std::string& data_file,
                       const telemetry::AircraftConfiguration& aircraft,
                       const std::vector<telemetry::MessageDefinition>& messages) {
    pugi::xml_document xml;
    xml.append_child(pugi::node_comment).set_value(comment.c_str());
    auto configuration = xml.append_child("configuration");
    configuration.append_attribute("time_of_day") = "1577872800.00";
    configuration.append_attribute("data_file") = data_file.c_str();
    auto conf = configuration.append_child("conf");
    add_aircraft(conf, aircraft);
    auto telemetry = configuration.append_child("protocol").append_child("msg_class");
    telemetry.append_attribute("NAME") = "telemetry";
    telemetry.append_attribute("ID") = 1;
    int id = 1;
    for (const auto& definition : messages) add_message(telemetry, definition, id++);
    std::ostringstream text;
    xml.save(text, "  ", pugi::format_indent | pugi::format_no_declaration);
    return std::move(text).str();
}

std::vector<PeriodicMessage> periodic_messages() {
    std::vector<PeriodicMessage> reports;
    for (const auto& row : message_rows) reports.push_back(report_of(row));
    return reports;
}

}  // namespace flightwatt::synthetic
