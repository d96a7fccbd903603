#include "synthetic/sensor_messages.h"

#include "base/units.h"
#include "synthetic/log_writer.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace flightwatt::synthetic {
namespace {

constexpr double reference_east_m = 588000.0;
constexpr double reference_north_m = 6148000.0;

telemetry::MessageDefinition message(const char* name, std::vector<telemetry::FieldDefinition> fields) {
    return {name, std::move(fields), ".log"};
}

std::string hundredths(double value) { return ocaml_float(std::round(value * 100.0) / 100.0); }

std::string whole(double value) { return fmt::format("{}", std::llround(value)); }

/// Messages that power and phases are read from.
std::vector<Report> flight_reports() {
    return {
        {1.1,
         message("ENERGY", {{"throttle", "uint8", "%", "", {}},
                            {"voltage", "float", "V", "", {}},
                            {"current", "float", "A", "", {}},
                            {"power", "float", "W", "", {}},
                            {"charge", "float", "Ah", "", {}},
                            {"energy", "float", "Wh", "", {}}}),
         [](const Moment& m) {
             return std::vector{whole(m.state.throttle_percent), ocaml_float(m.voltage_v),
                                ocaml_float(m.current_a),        ocaml_float(m.voltage_v * m.current_a),
                                ocaml_float(m.charge_ah),        ocaml_float(m.energy_wh)};
         }},
        {0.5, message("ESTIMATOR", {{"z", "float", "m", "", {}}, {"z_dot", "float", "m/s", "", {}}}),
         [](const Moment& m) {
             return std::vector{ocaml_float(m.altitude_m), hundredths(m.state.climb_m_per_s)};
         }},
        {0.5,
         message("NAVIGATION", {{"cur_block", "uint8", "", "", {}},
                                {"cur_stage", "uint8", "", "", {}},
                                {"pos_x", "float", "m", "", {}},
                                {"pos_y", "float", "m", "", {}},
                                {"dist_wp", "float", "m", "", {}},
                                {"dist_home", "float", "m", "", {}},
                                {"flight_time", "uint16", "s", "", {}},
                                {"block_time", "uint16", "s", "", {}},
                                {"stage_time", "uint16", "s", "", {}},
                                {"kill_auto_throttle", "uint8", "bool", "", {}},
                                {"circle_count", "uint8", "", "", {}},
                                {"oval_count", "uint8", "", "", {}}}),
         [](const Moment& m) {
             const auto tenths = [](double value) { return ocaml_float(std::round(value * 10.0) / 10.0); };
             return std::vector{std::to_string(m.state.block),
                                std::string("0"),
                                tenths(m.state.east_m),
                                tenths(m.state.north_m),
                                tenths(0.0),
                                tenths(std::hypot(m.state.east_m, m.state.north_m)),
                                whole(m.flight_time_s),
                                std::string("0"),
                                std::string("0"),
                                std::string(m.state.power_w > 0.0 ? "0" : "1"),
                                std::string("0"),
                                std::string("0")};
         }},
        {5.0,
         message("PPRZ_MODE", {{"ap_mode", "uint8", "", "", {}},
                               {"ap_gaz", "uint8", "", "", {}},
                               {"ap_lateral", "uint8", "", "", {}},
                               {"ap_horizontal", "uint8", "", "", {}},
                               {"if_calib_mode", "uint8", "", "", {}},
                               {"mcu1_status", "uint8", "", "", {}}}),
         [](const Moment& m) {
             const std::string automatic = m.state.mode == 2 ? "3" : "0";
             return std::vector{std::to_string(m.state.mode),
                                automatic,
                                automatic,
                                std::string("2"),
                                std::string("0"),
                                std::string("17")};
         }},
    };
}

/// Messages that fill a real log too.
std::vector<Report> other_reports() {
    return {
        {0.15,
         message("ATTITUDE", {{"phi", "float", "rad", "", {}},
                              {"psi", "float", "rad", "", {}},
                              {"theta", "float", "rad", "", {}}}),
         [](const Moment& m) {
             const double heading = std::remainder(m.state.course_rad, 2.0 * std::numbers::pi);
             return std::vector{ocaml_float(m.state.airborne ? -0.21 : 0.0), ocaml_float(heading),
                                ocaml_float(m.state.climb_m_per_s / 20.0)};
         }},
        {0.5,
         message("GPS", {{"mode", "uint8", "byte_mask", "", {}},
                         {"utm_east", "int32", "cm", "", {}},
                         {"utm_north", "int32", "cm", "", {}},
                         {"course", "int16", "decideg", "", {}},
                         {"alt", "int32", "mm", "", {}},
                         {"speed", "uint16", "cm/s", "", {}},
                         {"climb", "int16", "cm/s", "", {}},
                         {"week", "uint16", "weeks", "", {}},
                         {"itow", "uint32", "ms", "", {}},
                         {"utm_zone", "uint8", "", "", {}},
                         {"gps_nb_err", "uint8", "", "", {}}}),
         [](const Moment& m) {
             return std::vector{std::string("3"),
                                whole((reference_east_m + m.state.east_m) * 100.0),
                                whole((reference_north_m + m.state.north_m) * 100.0),
                                whole(m.state.course_rad * 1800.0 / std::numbers::pi),
                                whole(m.altitude_m * 1000.0),
                                whole(m.state.ground_speed_m_per_s * 100.0),
                                whole(m.state.climb_m_per_s * 100.0),
                                std::string("2112"),
                                whole(378000000.0 + m.time_s * 1000.0),
                                std::string("32"),
                                std::string("0")};
         }},
        {0.3,
         message("DESIRED", {{"roll", "float", "rad", "", {}},
                             {"pitch", "float", "rad", "", {}},
                             {"course", "float", "rad", "", {}},
                             {"x", "float", "m", "", {}},
                             {"y", "float", "m", "", {}},
                             {"altitude", "float", "m", "", {}},
                             {"climb", "float", "m/s", "", {}},
                             {"airspeed", "float", "m/s", "", {}}}),
         [](const Moment& m) {
             return std::vector{ocaml_float(m.state.airborne ? -0.2 : 0.0),
                                ocaml_float(0.05),
                                hundredths(m.state.course_rad),
                                whole(m.state.east_m),
                                whole(m.state.north_m),
                                whole(m.state.altitude_m),
                                hundredths(m.state.climb_m_per_s),
                                ocaml_float(13.0)};
         }},
        {0.6,
         message("SVINFO", {{"chn", "uint8", "", "", {}},
                            {"SVID", "uint8", "", "", {}},
                            {"Flags", "uint8", "", "", {}},
                            {"QI", "uint8", "", "", {}},
                            {"CNO", "uint8", "dbHz", "", {}},
                            {"Elev", "int8", "deg", "", {}},
                            {"Azim", "int16", "deg", "", {}}}),
         [](const Moment& m) {
             const auto channel = static_cast<int>(m.time_s / 0.6) % 12;
             return std::vector{std::to_string(channel),     std::to_string(channel + 3),
                                std::string("13"),           std::string("7"),
                                std::string("36"),           std::to_string(7 * channel),
                                std::to_string(29 * channel)};
         }},
        // No AIRSPEED: the synthetic power does not follow it, and a sensor would suggest that it did.
        {0.9,
         message("IMU_GYRO", {{"gp", "float", "rad/s", "", {}},
                              {"gq", "float", "rad/s", "", {}},
                              {"gr", "float", "rad/s", "", {}}}),
         [](const Moment& m) {
             const auto turn = ocaml_float(m.state.airborne ? -0.16 : 0.0);
             return std::vector{ocaml_float(0.0), ocaml_float(0.0), turn};
         }},
        {1.2,
         message("WP_MOVED", {{"wp_id", "uint8", "", "", {}},
                              {"utm_east", "float", "m", "", {}},
                              {"utm_north", "float", "m", "", {}},
                              {"alt", "float", "m", "", {}},
                              {"utm_zone", "uint8", "", "", {}}}),
         [](const Moment& m) {
             const auto waypoint = static_cast<int>(m.time_s / 1.2) % 10;
             return std::vector{std::to_string(waypoint), ocaml_float(reference_east_m + 20.5 * waypoint),
                                ocaml_float(reference_north_m + 13.25 * waypoint), ocaml_float(105.0),
                                std::string("32")};
         }},
        {5.0, message("COMMANDS", {{"values", "int16[]", "ticks", "", {}}}),
         [](const Moment& m) {
             return std::vector{
                 fmt::format("{:.0f},-240,1030", units::pprz_from_percent(m.state.throttle_percent))};
         }},
        {10.0,
         message("WIND_INFO", {{"ac_id", "uint8", "", "", {}},
                               {"flags", "uint8", "", "", {}},
                               {"east", "float", "m/s", "", {}},
                               {"north", "float", "m/s", "", {}},
                               {"up", "float", "m/s", "", {}},
                               {"airspeed", "float", "m/s", "", {}}}),
         [](const Moment& m) {
             return std::vector{std::string("7"),
                                std::string("5"),
                                hundredths(m.state.wind_east_m_per_s),
                                hundredths(m.state.wind_north_m_per_s),
                                ocaml_float(0.0),
                                ocaml_float(m.state.airborne ? m.state.airspeed_m_per_s : 0.0)};
         }},
        {2.0,
         message("FBW_STATUS", {{"rc_status", "uint8", "", "", {}},
                                {"frame_rate", "uint8", "Hz", "", {}},
                                {"mode", "uint8", "", "", {}},
                                {"vsupply", "float", "V", "", {}},
                                {"current", "float", "A", "", {}}}),
         [](const Moment& m) {
             return std::vector{std::string("0"), std::string("61"), std::string("0"),
                                ocaml_float(m.voltage_v), ocaml_float(m.current_a)};
         }},
        {5.1, message("ALIVE", {{"md5sum", "uint8[]", "", "", {}}}),
         [](const Moment&) {
             return std::vector{std::string("104,72,204,189,120,93,193,159,136,145,150,137,96,217,124,229")};
         }},
        {5.0, message("PONG", {}), [](const Moment&) { return std::vector<std::string>{}; }},
        {7.1,
         message("LOGGER_STATUS", {{"status", "uint8", "", "", {}},
                                   {"errno", "uint8", "", "", {}},
                                   {"used", "uint32", "", "", {}},
                                   {"logfile", "char[]", "", "", {}}}),
         [](const Moment& m) {
             return std::vector{std::string("1"), std::string("0"), whole(m.time_s * 512.0),
                                std::string(", FLIGHT_RECORDER\\fr_0001.LOG")};
         }},
    };
}

}  // namespace

std::vector<Report> telemetry_reports() {
    auto reports = flight_reports();
    for (auto& report : other_reports()) reports.push_back(std::move(report));
    return reports;
}

}  // namespace flightwatt::synthetic
