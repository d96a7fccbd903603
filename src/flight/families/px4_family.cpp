#include "flight/families/px4_family.h"

#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

/// Where PX4's ULog has the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

constexpr double no_sensor = -1.0;

/// Motors that are off have no value.
double percent_of_fraction(const std::vector<double>& row) {
    return std::isnan(row[0]) ? 0.0 : row[0] * units::percent_per_whole;
}

double percent_of_thrust(const std::vector<double>& row) {
    return std::hypot(row[0], row[1], row[2]) * units::percent_per_whole;
}

double to_heading(double east, double north) {
    constexpr double turn_deg = 360.0;
    const double deg = std::atan2(east, north) * units::degree_per_rad;
    return deg < 0.0 ? deg + turn_deg : deg;
}

double course_of(const std::vector<double>& north_east) { return to_heading(north_east[1], north_east[0]); }

double roll_of(const std::vector<double>& q) {
    return std::atan2(2.0 * (q[0] * q[1] + q[2] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])) *
           units::degree_per_rad;
}

double heading_of(const std::vector<double>& q) {
    return to_heading(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

double is_armed(const std::vector<double>& state) {
    constexpr double armed_state = 2.0;
    return state[0] == armed_state ? 1.0 : 0.0;
}

/// Until 1.12: whether it flies as a rotorcraft, is in a transition, and in one to its wing.
double vtol_state_of(const std::vector<double>& flags) {
    return if_vtol_status({1.0, flags[0] != 0.0 ? 1.0 : 0.0, flags[1], flags[2]});
}

const std::vector<FamilyTrack>& px4_tracks() {
    constexpr auto mean = Merge::mean;
    constexpr auto latest = Merge::latest;
    const FamilySource current{"current_a", "A", nullptr, no_sensor};
    const std::vector<FamilySource> velocity{{"vx"}, {"vy"}};
    const std::vector<FamilySource> quaternion{{"q[0]"}, {"q[1]"}, {"q[2]"}, {"q[3]"}};
    static const std::vector<FamilyTrack> tracks{
        {"power_w", "battery_status", {{"voltage_v", "V"}, current}, mean, product},
        {"altitude_m", "vehicle_air_data", {{"baro_alt_meter", "m"}}},
        {"altitude_m", "sensor_combined", {{"baro_alt_meter", "m"}}},
        {"altitude_m", "vehicle_global_position", {{"alt", "m"}}},
        {"altitude_m", "vehicle_local_position", {{"z", "-1m"}}},
        {"altitude_m", "vehicle_gps_position", {{"altitude_msl_m", "m"}}},
        {"altitude_m", "vehicle_gps_position", {{"alt", "mm"}}},
        {"voltage_v", "battery_status", {{"voltage_v", "V"}}},
        {"current_a", "battery_status", {current}},
        {"charge_ah", "battery_status", {{"discharged_mah", "mAh", nullptr, no_sensor}}, latest},
        {"battery_temperature_c", "battery_status", {{"temperature", "degC"}}, mean, if_stated_temperature},
        {"east_m", "vehicle_local_position", {{"y", "m"}}},
        {"north_m", "vehicle_local_position", {{"x", "m"}}},
        {"airspeed_m_per_s", "airspeed_validated", {{"calibrated_airspeed_m_s", "m/s"}}},
        {"airspeed_m_per_s", "airspeed_validated", {{"indicated_airspeed_m_s", "m/s"}}},
        {"airspeed_m_per_s", "airspeed", {{"indicated_airspeed_m_s", "m/s"}}},
        {"wind_east_m_per_s", "wind", {{"windspeed_east", "m/s"}}},
        {"wind_east_m_per_s", "airspeed_wind", {{"windspeed_east", "m/s"}}},
        {"wind_east_m_per_s", "wind_estimate", {{"windspeed_east", "m/s"}}},
        {"wind_north_m_per_s", "wind", {{"windspeed_north", "m/s"}}},
        {"wind_north_m_per_s", "airspeed_wind", {{"windspeed_north", "m/s"}}},
        {"wind_north_m_per_s", "wind_estimate", {{"windspeed_north", "m/s"}}},
        {"latitude_deg", "vehicle_gps_position", {{"latitude_deg", "deg"}}, latest},
        {"latitude_deg", "vehicle_gps_position", {{"lat", "1e7deg"}}, latest},
        {"latitude_deg", "vehicle_global_position", {{"lat", "deg"}}, latest},
        {"longitude_deg", "vehicle_gps_position", {{"longitude_deg", "deg"}}, latest},
        {"longitude_deg", "vehicle_gps_position", {{"lon", "1e7deg"}}, latest},
        {"longitude_deg", "vehicle_global_position", {{"lon", "deg"}}, latest},
        {"climb_m_per_s", "vehicle_local_position", {{"vz", "-1m/s"}}},
        {"mode", "vehicle_status", {{"nav_state"}}, latest},
        {"landed", "vehicle_land_detected", {{"landed"}}, latest},
        {"fix", "vehicle_gps_position", {{"fix_type"}}, latest},
        {"vtol_state", "vtol_vehicle_status", {{"vehicle_vtol_state"}}, latest, if_vtol_state},
        {"vtol_state",
         "vtol_vehicle_status",
         {{"vtol_in_rw_mode"}, {"vtol_in_trans_mode"}, {"in_transition_to_fw"}},
         latest,
         vtol_state_of},
        {"vtol_state",  // logs without vtol_vehicle_status
         "vehicle_status",
         {{"is_vtol"}, {"vehicle_type"}, {"in_transition_mode"}, {"in_transition_to_fw"}},
         latest,
         if_vtol_status},
        {"vtol_state",  // until 1.10
         "vehicle_status",
         {{"is_vtol"}, {"is_rotary_wing"}, {"in_transition_mode"}, {"in_transition_to_fw"}},
         latest,
         if_vtol_status},
        {"ground_speed_m_per_s", "vehicle_local_position", velocity, mean, speed_of},
        {"course_deg", "vehicle_local_position", velocity, latest, course_of},
        {"heading_deg", "vehicle_attitude", quaternion, latest, heading_of},
        {"roll_deg", "vehicle_attitude", quaternion, latest, roll_of},
        {"throttle_percent", "actuator_motors", {{"control[0]"}}, mean, percent_of_fraction},
        {"throttle_percent", "actuator_controls_0", {{"control[3]"}}, mean, percent_of_fraction},
        {"throttle_percent", "vehicle_thrust_setpoint", {{"xyz[0]"}, {"xyz[1]"}, {"xyz[2]"}}, mean, percent_of_thrust},
        {"armed", "vehicle_status", {{"arming_state"}}, latest, is_armed},
        {utc_track, "vehicle_gps_position", {{"time_utc_usec", "1e-6s"}}, latest},
    };
    return tracks;
}

const std::vector<FamilyTrack>& sdlog2_tracks() {
    constexpr auto mean = Merge::mean;
    constexpr auto latest = Merge::latest;
    const FamilySource current{"C", "A", nullptr, no_sensor};
    const std::vector<FamilySource> velocity{{"VelN"}, {"VelE"}};
    static const std::vector<FamilyTrack> tracks{
        {"power_w", "BATT", {{"V", "V"}, current}, mean, product},
        {"altitude_m", "SENS", {{"BaroAlt", "m"}}},
        {"altitude_m", "GPOS", {{"Alt", "m"}}},
        {"altitude_m", "LPOS", {{"Z", "-1m"}}},
        {"altitude_m", "GPS", {{"Alt", "m"}}},
        {"voltage_v", "BATT", {{"V", "V"}}},
        {"current_a", "BATT", {current}},
        {"charge_ah", "BATT", {{"Discharged", "mAh", nullptr, no_sensor}}, latest},
        {"east_m", "LPOS", {{"Y", "m"}}},
        {"north_m", "LPOS", {{"X", "m"}}},
        {"airspeed_m_per_s", "AIRS", {{"IAS", "m/s"}}},
        {"airspeed_m_per_s", "AIRS", {{"IndSpeed", "m/s"}}},
        {"wind_east_m_per_s", "WIND", {{"Y", "m/s"}}},
        {"wind_north_m_per_s", "WIND", {{"X", "m/s"}}},
        {"latitude_deg", "GPS", {{"Lat", "deg"}}, latest},
        {"latitude_deg", "GPOS", {{"Lat", "deg"}}, latest},
        {"longitude_deg", "GPS", {{"Lon", "deg"}}, latest},
        {"longitude_deg", "GPOS", {{"Lon", "deg"}}, latest},
        {"ground_speed_m_per_s", "GPOS", velocity, mean, speed_of},
        {"ground_speed_m_per_s", "LPOS", {{"VX"}, {"VY"}}, mean, speed_of},
        {"course_deg", "GPOS", velocity, latest, course_of},
        {"climb_m_per_s", "LPOS", {{"VZ", "-1m/s"}}},
        {"heading_deg", "ATT", {{"Yaw", "rad"}}, latest},
        {"roll_deg", "ATT", {{"Roll", "rad"}}, latest},
        {"throttle_percent", "ATTC", {{"Thrust"}}, mean, percent_of_fraction},
        {"mode", "STAT", {{"NavState"}}, latest},
        {"mode", "STAT", {{"MainState"}}, latest},
        {"armed", "STAT", {{"ArmS"}}, latest, is_armed},
        {"armed", "STAT", {{"ArmState"}}, latest, is_armed},
        {"landed", "LAND", {{"Landed"}}, latest},
        {"landed", "STAT", {{"Landed"}}, latest},
        {"fix", "GPS", {{"Fix"}}, latest},
        {utc_track, "GPS", {{"GPSTime", "1e-6s"}}, latest},
    };
    return tracks;
}

/// The kind of vehicle by MAVLink's number, else by the status: "" if neither states it.
std::string vehicle_kind(const telemetry::AutopilotLog& log) {
    const auto& parameters = log.facts.parameters;
    if (const auto type = parameters.find("MAV_TYPE"); type != parameters.end()) return firmware_of_type(type->second);
    const auto* status = log.log.senders.front().table("vehicle_status");
    if (status == nullptr) return "";
    const auto* vtol = status->column("is_vtol");
    if (vtol != nullptr && vtol->values.front() != 0.0) return "";
    if (const auto* kind = status->column("vehicle_type")) {
        constexpr std::array names{"", "rotorcraft", "fixedwing", "rover"};
        const double number = kind->values.front();
        return number >= 0.0 && number < static_cast<double>(names.size()) ? names[static_cast<std::size_t>(number)]
                                                                           : "";
    }
    const auto* rotary = status->column("is_rotary_wing");
    return rotary == nullptr ? "" : rotary->values.front() != 0.0 ? "rotorcraft" : "fixedwing";
}

/// The cells of batteries, and the serial numbers and cycles of smart ones, as the first message of each instance states them; its `id` is only
/// a place in the vehicle.
void add_packs(const telemetry::SenderLog& sender, FlightSeries& series) {
    const auto* status = sender.table("battery_status");
    if (status == nullptr) return;
    const auto* instance = status->column("multi_id");
    const auto* serial = status->column("serial_number");
    const auto* cycles = status->column("cycle_count");
    const auto* cells = status->column("cell_count");
    const auto* source = status->column("source");
    constexpr double escs = 2.0;
    std::set<double> seen;
    std::vector<double> serials;
    for (std::size_t row = 0; row < status->time_s.size(); ++row) {
        const double id = instance == nullptr ? 0.0 : instance->values[row];
        if (!seen.insert(id).second) continue;
        if (cells != nullptr && cells->values[row] > 0.0)
            series.monitor_cells.insert_or_assign(fmt::format("{}", id), cells->values[row]);
        if (source != nullptr && source->values[row] == escs)
            series.monitor_kinds[fmt::format("{}", id)] = escs_monitor;
        if (serial != nullptr) serials.push_back(serial->values[row]);
        if (cycles != nullptr && is_stated(cycles->values[row]))
            series.pack_cycles = std::max(series.pack_cycles.value_or(0.0), cycles->values[row]);
    }
    series.pack_serial = joined_serials(serials);
}

void describe_px4(const telemetry::AutopilotLog& log, FlightSeries& series) {
    const auto& parameters = log.facts.parameters;
    const auto text_of = [&](const char* key) {
        const auto found = log.facts.information.find(key);
        return found == log.facts.information.end() ? std::string() : found->second;
    };
    series.aircraft_id = text_of("sys_uuid");
    series.aircraft_name = "PX4";
    const auto hitl = parameters.find("SYS_HITL");
    if (text_of("ver_hw").find("SITL") != std::string::npos)
        series.aircraft_name += " SITL";
    else if (hitl != parameters.end() && hitl->second > 0.0)
        series.aircraft_name += " HITL";
    series.firmware = vehicle_kind(log);
    series.monitor_capacities_ah =
        monitor_capacities_ah(parameters, {"BAT1_CAPACITY", "BAT_CAPACITY"}, "BATN_CAPACITY");
    series.monitor_cells = monitor_parameters(parameters, {"BAT1_N_CELLS", "BAT_N_CELLS"}, "BATN_N_CELLS");
    add_packs(log.log.senders.front(), series);
}

}  // namespace

const LogFamily& sdlog2_family() {
    static const LogFamily family{sdlog2_tracks(), {{"GPS", nullptr, "Fix", min_fix}}, describe_px4};
    return family;
}

const LogFamily& px4_family() {
    static const LogFamily family{px4_tracks(),
                                  {{"battery_status", "multi_id"},
                                   {"vehicle_gps_position", "multi_id", "fix_type", min_fix},
                                   {"vehicle_air_data", "multi_id"},
                                   {"airspeed", "multi_id"},
                                   {"wind_estimate", "multi_id"},
                                   {"vehicle_local_position", "multi_id"}},
                                  describe_px4,
                                  {{"vehicle_status", {"vehicle_type", "is_rotary_wing", "is_vtol"}},
                                   {"battery_status", {"serial_number", "cycle_count", "cell_count", "source"}}}};
    return family;
}

}  // namespace flightwatt::flight
