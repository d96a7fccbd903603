#include "flight/telemetry_series.h"

#include "flight/sources/logged_tracks.h"

#include <algorithm>
#include <limits>
#include <set>

namespace flightwatt::flight {
namespace {

void add_configuration(FlightSeries& series, const telemetry::TelemetryLog& log) {
    series.lacks_log = !log.configuration;
    series.assumed_definitions = log.assumed_definitions;
    series.skipped = log.skipped;
    if (!log.configuration) return;
    const auto found = log.configuration->aircraft.find(series.aircraft_id);
    if (found == log.configuration->aircraft.end()) return;
    const auto& aircraft = found->second;
    series.aircraft_name = aircraft.name;
    series.block_names = aircraft.block_names;
    series.planned_ground_altitude_m = aircraft.ground_altitude_m;
    series.current_origin = aircraft.current_origin;
}

/// Times may come a little late; a jump back of a minute is another log, or another boot, behind the first
/// one. Of all that show it, the pair of times that shows it first.
std::optional<ClockRestart> restart_in(const telemetry::MessageTable& table) {
    constexpr double late_s = 60.0;
    double latest_s = -std::numeric_limits<double>::infinity();
    const bool none = std::none_of(table.time_s.begin(), table.time_s.end(), [&](double time_s) {
        latest_s = std::max(latest_s, time_s);
        return latest_s - time_s > late_s;
    });
    std::optional<ClockRestart> restart;
    if (none) return restart;
    std::set<double> seen_s;
    for (const double time_s : table.time_s) {
        const auto first = seen_s.upper_bound(time_s + late_s);
        if (first != seen_s.end() && (!restart || *first < restart->known_s)) {
            restart = {*first, *seen_s.rbegin(), time_s, table.message};
        }
        seen_s.insert(time_s);
    }
    return restart;
}

}  // namespace

std::vector<telemetry::MessageRequest> flight_messages() {
    return {
        {"ENERGY", {"throttle", "voltage", "bat", "current", "amp", "power", "charge", "energy"}},
        {"BAT", {"throttle", "voltage", "amps", "energy"}},
        {"ESC", {"amps", "bat_volts", "power", "node_id", "motor_id"}},
        {"POWER_DEVICE", {"node_id", "circuit", "current", "voltage"}},
        {"ESTIMATOR", {"z", "z_dot"}},
        {"GPS", {"utm_east", "utm_north", "course", "alt", "speed", "climb", "utm_zone"}},
        {"GPS_INT", {"lat", "lon", "hmsl", "ecef_xd", "ecef_yd", "ecef_zd"}},
        {"GPS_LLA", {"lat", "lon"}},
        {"AIR_DATA", {"amsl_baro", "airspeed"}},
        {"AIRSPEED", {"airspeed"}},
        {"ROTORCRAFT_FP", {"east", "north", "up", "vup", "phi", "psi", "thrust"}},
        {"ATTITUDE", {"phi", "psi"}},
        {"NAVIGATION", {"cur_block", "pos_x", "pos_y"}},
        {"NAVIGATION_REF", {"ground_alt"}},
        {"PPRZ_MODE", {"ap_mode"}},
        {"TAKEOFF", {"cpu_time"}},
        {"WIND_INFO", {"east", "north"}},
    };
}

std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log) {
    const auto is_telemetry = [](const telemetry::MessageTable& table) {
        return table.message != "TAKEOFF" && table.message != "PPRZ_MODE" &&
               table.message != "NAVIGATION_REF";
    };
    std::vector<std::string> ids;
    for (const auto& sender : log.senders) {
        if (std::ranges::any_of(sender.tables, is_telemetry)) ids.push_back(sender.id);
    }
    return ids;
}

FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id) {
    FlightSeries series;
    series.file = log.data_file.string();
    series.flight = log.flight;
    series.aircraft_id = aircraft_id;
    add_configuration(series, log);
    const auto sender = std::find_if(log.senders.begin(), log.senders.end(),
                                     [&](const telemetry::SenderLog& s) { return s.id == aircraft_id; });
    if (sender == log.senders.end()) return series;
    series.tracks = logged_tracks(*sender, !log.configuration);
    for (const auto& table : sender->tables) {
        const auto restart = restart_in(table);
        if (restart && (!series.clock_restart || restart->known_s < series.clock_restart->known_s)) {
            series.clock_restart = restart;
        }
    }
    return series;
}

}  // namespace flightwatt::flight
