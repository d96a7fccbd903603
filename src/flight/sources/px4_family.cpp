#include "base/units.h"
#include "flight/sources/log_family.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

/// Where PX4's ULog has the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

using telemetry::MessageTable;

constexpr double no_sensor = -1.0;

const std::vector<FamilyField>& px4_fields() {
    using enum FamilyField::Stored;
    static const std::vector<FamilyField> fields{
        {"altitude_m", "vehicle_air_data", "baro_alt_meter", "m"},
        {"altitude_m", "vehicle_global_position", "alt", "m"},
        {"altitude_m", "vehicle_local_position", "z", "-1m"},
        {"altitude_m", "vehicle_gps_position", "altitude_msl_m", "m"},
        {"altitude_m", "vehicle_gps_position", "alt", "mm"},
        {"voltage_v", "battery_status", "voltage_v", "V"},
        {"current_a", "battery_status", "current_a", "A", Merge::mean, any, no_sensor},
        {"charge_ah", "battery_status", "discharged_mah", "mAh", Merge::latest, any, no_sensor},
        {"east_m", "vehicle_local_position", "y", "m"},
        {"north_m", "vehicle_local_position", "x", "m"},
        {"airspeed_m_per_s", "airspeed_validated", "calibrated_airspeed_m_s", "m/s"},
        {"airspeed_m_per_s", "airspeed_validated", "indicated_airspeed_m_s", "m/s"},
        {"airspeed_m_per_s", "airspeed", "indicated_airspeed_m_s", "m/s"},
        {"wind_east_m_per_s", "wind", "windspeed_east", "m/s"},
        {"wind_east_m_per_s", "airspeed_wind", "windspeed_east", "m/s"},
        {"wind_east_m_per_s", "wind_estimate", "windspeed_east", "m/s"},
        {"wind_north_m_per_s", "wind", "windspeed_north", "m/s"},
        {"wind_north_m_per_s", "airspeed_wind", "windspeed_north", "m/s"},
        {"wind_north_m_per_s", "wind_estimate", "windspeed_north", "m/s"},
        {"latitude_deg", "vehicle_gps_position", "latitude_deg", "deg", Merge::latest},
        {"latitude_deg", "vehicle_gps_position", "lat", "1e7deg", Merge::latest},
        {"latitude_deg", "vehicle_global_position", "lat", "deg", Merge::latest},
        {"longitude_deg", "vehicle_gps_position", "longitude_deg", "deg", Merge::latest},
        {"longitude_deg", "vehicle_gps_position", "lon", "1e7deg", Merge::latest},
        {"longitude_deg", "vehicle_global_position", "lon", "deg", Merge::latest},
        {"climb_m_per_s", "vehicle_local_position", "vz", "-1m/s"},
        {"mode", "vehicle_status", "nav_state", "", Merge::latest},
        {"landed", "vehicle_land_detected", "landed", "", Merge::latest},
    };
    return fields;
}

/// A track that is computed from fields of one topic.
struct ComputedTrack {
    const char* track;
    const char* topic;
    std::vector<const char*> fields;
    double (*compute)(const std::vector<double>& row);
    Merge merge = Merge::mean;
};

constexpr double armed_state = 2.0;

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

double roll_of(const std::vector<double>& q) {
    return std::atan2(2.0 * (q[0] * q[1] + q[2] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])) *
           units::degree_per_rad;
}

double heading_of(const std::vector<double>& q) {
    return to_heading(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

const std::vector<ComputedTrack>& computed_tracks() {
    static const std::vector<ComputedTrack> computed{
        {"throttle_percent", "actuator_motors", {"control[0]"}, percent_of_fraction},
        {"throttle_percent", "actuator_controls_0", {"control[3]"}, percent_of_fraction},
        {"throttle_percent", "vehicle_thrust_setpoint", {"xyz[0]", "xyz[1]", "xyz[2]"}, percent_of_thrust},
        {"ground_speed_m_per_s",
         "vehicle_local_position",
         {"vx", "vy"},
         [](const auto& row) { return std::hypot(row[0], row[1]); }},
        {"course_deg",
         "vehicle_local_position",
         {"vx", "vy"},
         [](const auto& row) { return to_heading(row[1], row[0]); },
         Merge::latest},
        {"heading_deg", "vehicle_attitude", {"q[0]", "q[1]", "q[2]", "q[3]"}, heading_of, Merge::latest},
        {"roll_deg", "vehicle_attitude", {"q[0]", "q[1]", "q[2]", "q[3]"}, roll_of, Merge::latest},
        {"armed",
         "vehicle_status",
         {"arming_state"},
         [](const auto& row) { return row[0] == armed_state ? 1.0 : 0.0; },
         Merge::latest}};
    return computed;
}

void add_computed(const FamilyLog& log, std::vector<Track>& tracks) {
    for (const auto& [track, topic, fields, compute, merge] : computed_tracks()) {
        const auto* table = log.table(topic);
        if (table == nullptr) continue;
        std::vector<const telemetry::Column*> columns;
        for (const auto* field : fields) columns.push_back(table->column(field));
        if (std::ranges::find(columns, nullptr) != columns.end()) continue;
        std::vector<double> values(table->time_s.size());
        std::vector<double> row(columns.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            std::ranges::transform(columns, row.begin(), [&](const auto* column) { return column->values[i]; });
            values[i] = compute(row);
        }
        add_track(tracks, track, fmt::format("{}.{}", topic, fields.front()), *table, values, merge);
    }
}

/// The kind of vehicle by MAVLink's number, else by the status: "" if neither states it.
std::string vehicle_kind(const FamilyLog& log) {
    constexpr std::array rotorcraft{2.0, 3.0, 4.0, 13.0, 14.0, 15.0, 29.0};
    constexpr double fixed_wing = 1.0;
    constexpr double ground_rover = 10.0;
    const auto& parameters = log.facts.parameters;
    if (const auto type = parameters.find("MAV_TYPE"); type != parameters.end()) {
        if (std::ranges::find(rotorcraft, type->second) != rotorcraft.end()) return "rotorcraft";
        return type->second == fixed_wing ? "fixedwing" : type->second == ground_rover ? "rover" : "";
    }
    const auto* status = log.table("vehicle_status");
    if (status == nullptr) return "";
    if (const auto* kind = status->column("vehicle_type")) {
        constexpr std::array names{"", "rotorcraft", "fixedwing", "rover"};
        const double number = kind->values.front();
        return number >= 0.0 && number < static_cast<double>(names.size()) ? names[static_cast<std::size_t>(number)]
                                                                           : "";
    }
    const auto* rotary = status->column("is_rotary_wing");
    return rotary == nullptr ? "" : rotary->values.front() != 0.0 ? "rotorcraft" : "fixedwing";
}

/// Unix time of the log's second 0, from the first GPS time.
std::optional<double> clock_of_gps(const FamilyLog& log) {
    const auto* gps = log.table("vehicle_gps_position");
    const auto* utc_us = gps == nullptr ? nullptr : gps->column("time_utc_usec");
    if (utc_us == nullptr || !(utc_us->values.front() > 0.0)) return std::nullopt;
    return utc_us->values.front() * units::micro - gps->time_s.front();
}

void describe_px4(const FamilyLog& log, FlightSeries& series) {
    const auto& [information, parameters, texts, dropouts, dropout_s] = log.facts;
    const auto text_of = [&](const char* key) {
        const auto found = information.find(key);
        return found == information.end() ? std::string() : found->second;
    };
    series.aircraft_id = text_of("sys_uuid");
    series.aircraft_name = "PX4";
    const auto hitl = parameters.find("SYS_HITL");
    if (text_of("ver_hw").find("SITL") != std::string::npos)
        series.aircraft_name += " SITL";
    else if (hitl != parameters.end() && hitl->second > 0.0)
        series.aircraft_name += " HITL";
    series.firmware = vehicle_kind(log);
    series.start_clock_s = clock_of_gps(log);
}

std::vector<telemetry::MessageRequest> further_fields() {
    std::vector<telemetry::MessageRequest> more{{"vehicle_status", {"vehicle_type", "is_rotary_wing"}},
                                                {"vehicle_gps_position", {"time_utc_usec"}}};
    for (const auto& computed : computed_tracks())
        more.push_back({computed.topic, {computed.fields.begin(), computed.fields.end()}});
    return more;
}

}  // namespace

const LogFamily& px4_family() {
    static const LogFamily family{
        px4_fields(),
        {{"battery_status", "multi_id"},
         {"vehicle_gps_position", "multi_id", "fix_type", 3.0},
         {"vehicle_air_data", "multi_id"},
         {"airspeed", "multi_id"},
         {"wind_estimate", "multi_id"},
         {"vehicle_local_position", "multi_id"}},
        {{"voltage_v", "battery_status", "voltage_v", "V"},
         {"current_a", "battery_status", "current_a", "A", Merge::mean, FamilyField::Stored::any, no_sensor}},
        further_fields(),
        add_computed,
        describe_px4,
        false};
    return family;
}

}  // namespace flightwatt::flight
