#include "flight/telemetry_series.h"

#include "base/units.h"
#include "flight/sources/derived_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double restart_s = 60.0;
constexpr double late_s = 2.0;
constexpr std::size_t enough_late_rows = 10;
constexpr double hole_intervals = 1.5;
constexpr std::size_t min_intervals = 5;
constexpr std::size_t max_intervals = 100;

bool has_late_rows(const telemetry::MessageTable& table, double later_than_s) {
    double latest_s = -std::numeric_limits<double>::infinity();
    return std::ranges::any_of(table.time_s, [&](double time_s) {
        latest_s = std::max(latest_s, time_s);
        return latest_s - time_s > later_than_s;
    });
}

/// A row seen before in the file, and the earliest time that shows it to be late (infinite: none).
struct SeenRow {
    std::size_t row;
    double late_by_s;
};
using SeenRows = std::multimap<double, SeenRow>;

bool differ(const telemetry::MessageTable& table, std::size_t a, std::size_t b) {
    return std::ranges::any_of(table.columns, [&](const telemetry::Column& column) {
        const double left = column.values[a];
        const double right = column.values[b];
        return left != right && !(std::isnan(left) && std::isnan(right));
    });
}

/// Whether a row is between rows of the file before it that lack none, considering only times up to `known_s`, so that
/// a log which ends there gives the same result.
bool is_overlap(const telemetry::MessageTable& table, std::size_t row, const SeenRows& seen, double known_s) {
    const double time_s = table.time_s[row];
    const auto counts = [&](SeenRows::const_iterator at) { return at->second.late_by_s > known_s; };
    auto above = seen.lower_bound(time_s);
    while (above != seen.end() && !counts(above)) ++above;
    if (above == seen.end()) return false;
    if (above->first == time_s) return differ(table, row, above->second.row);
    std::vector<double> before_s;
    for (auto at = seen.lower_bound(time_s); at != seen.begin() && before_s.size() <= max_intervals;) {
        --at;
        if (counts(at)) before_s.push_back(at->first);
    }
    if (before_s.size() <= min_intervals) return false;
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < before_s.size(); ++i) intervals_s.push_back(before_s[i - 1] - before_s[i]);
    const auto low = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 10);
    std::nth_element(intervals_s.begin(), low, intervals_s.end());
    return above->first - before_s.front() < hole_intervals * *low;
}

/// Restarts and overlapping rows of one message.
struct ClockFaults {
    std::optional<ClockRestart> restart;
    std::vector<ClockRestart> overlaps;
};

void add_faults(const telemetry::MessageTable& table, ClockFaults& faults) {
    if (!has_late_rows(table, late_s)) return;
    // Several devices report at one time and in any order.
    const bool may_overlap = table.message != "ESC" && table.message != "POWER_DEVICE";
    SeenRows seen;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        const double time_s = table.time_s[row];
        const auto shows = [&](double later_s) {
            const auto at = seen.upper_bound(time_s + later_s);
            return at == seen.end() ? std::numeric_limits<double>::infinity() : at->first;
        };
        const double restart_from_s = shows(restart_s);
        auto& restart = faults.restart;
        if (std::isfinite(restart_from_s) && (!restart || restart_from_s < restart->visible_from_s))
            restart = {restart_from_s, seen.rbegin()->first, time_s, table.message};
        const double known_s = shows(late_s);
        if (may_overlap && std::isfinite(known_s) && is_overlap(table, row, seen, known_s))
            faults.overlaps.push_back({known_s, known_s, time_s, table.message});
        seen.emplace(time_s, SeenRow{row, known_s});
    }
}

using units::Quantity;

/// A field that is a track without computation.
struct FieldTrack {
    const char* name;
    const char* message;
    const char* field;
    std::optional<Quantity> quantity;  ///< required of the field
    Merge merge;
};

/// In the order of preference within each name.
const std::vector<FieldTrack>& field_tracks() {
    constexpr auto metre = Quantity::metre;
    constexpr auto speed = Quantity::metre_per_second;
    constexpr auto degree = Quantity::degree;
    static const std::vector<FieldTrack> fields{
        {"altitude_m", "ESTIMATOR", "z", metre, Merge::mean},
        {"altitude_m", "ROTORCRAFT_FP", "up", metre, Merge::mean},
        {"altitude_m", "GPS", "alt", metre, Merge::mean},
        {"altitude_m", "GPS_INT", "hmsl", metre, Merge::mean},
        {"altitude_m", "AIR_DATA", "amsl_baro", metre, Merge::mean},
        {"throttle_percent", "ENERGY", "throttle", Quantity::percent, Merge::mean},
        {"throttle_percent", "BAT", "throttle", Quantity::percent, Merge::mean},
        {"voltage_v", "ENERGY", "voltage", Quantity::volt, Merge::mean},
        {"voltage_v", "ENERGY", "bat", Quantity::volt, Merge::mean},
        {"voltage_v", "BAT", "voltage", Quantity::volt, Merge::mean},
        {"voltage_v", "ESC", "bat_volts", Quantity::volt, Merge::mean},
        {"voltage_v", "POWER_DEVICE", "voltage", Quantity::volt, Merge::mean},
        {"current_a", "ENERGY", "current", Quantity::ampere, Merge::mean},
        {"current_a", "ENERGY", "amp", Quantity::ampere, Merge::mean},
        {"current_a", "BAT", "amps", Quantity::ampere, Merge::mean},
        {"power_w", "ENERGY", "power", Quantity::watt, Merge::mean},
        {"charge_ah", "ENERGY", "charge", Quantity::ampere_hour, Merge::latest},
        {"charge_ah", "ENERGY", "energy", Quantity::ampere_hour, Merge::latest},
        {"charge_ah", "BAT", "energy", Quantity::ampere_hour, Merge::latest},
        {"energy_wh", "ENERGY", "energy", Quantity::watt_hour, Merge::latest},
        {"east_m", "NAVIGATION", "pos_x", metre, Merge::mean},
        {"east_m", "ROTORCRAFT_FP", "east", metre, Merge::mean},
        {"east_m", "GPS", "utm_east", metre, Merge::mean},
        {"north_m", "NAVIGATION", "pos_y", metre, Merge::mean},
        {"north_m", "ROTORCRAFT_FP", "north", metre, Merge::mean},
        {"north_m", "GPS", "utm_north", metre, Merge::mean},
        {"ground_speed_m_per_s", "GPS", "speed", speed, Merge::mean},
        {"airspeed_m_per_s", "AIRSPEED", "airspeed", speed, Merge::mean},
        {"airspeed_m_per_s", "AIR_DATA", "airspeed", speed, Merge::mean},
        {"wind_east_m_per_s", "WIND_INFO", "east", speed, Merge::mean},
        {"wind_north_m_per_s", "WIND_INFO", "north", speed, Merge::mean},
        {"latitude_deg", "GPS_INT", "lat", degree, Merge::latest},
        {"latitude_deg", "GPS_LLA", "lat", degree, Merge::latest},
        {"longitude_deg", "GPS_INT", "lon", degree, Merge::latest},
        {"longitude_deg", "GPS_LLA", "lon", degree, Merge::latest},
        {"heading_deg", "ATTITUDE", "psi", degree, Merge::latest},
        {"heading_deg", "ROTORCRAFT_FP", "psi", degree, Merge::latest},
        {"course_deg", "GPS", "course", degree, Merge::latest},
        {"climb_m_per_s", "ESTIMATOR", "z_dot", speed, Merge::mean},
        {"climb_m_per_s", "ROTORCRAFT_FP", "vup", speed, Merge::mean},
        {"climb_m_per_s", "GPS", "climb", speed, Merge::mean},
        {"roll_deg", "ATTITUDE", "phi", degree, Merge::latest},
        {"roll_deg", "ROTORCRAFT_FP", "phi", degree, Merge::latest},
        {"air_temperature_c", "AIR_DATA", "temp", Quantity::celsius, Merge::mean},
        {"motor_speed_rpm", "ESC", "rpm", std::nullopt, Merge::mean},
        {"mode", "PPRZ_MODE", "ap_mode", std::nullopt, Merge::latest},
        {"block", "NAVIGATION", "cur_block", std::nullopt, Merge::latest},
        {"rover_mode", "ROVER_STATUS", "ap_mode", std::nullopt, Merge::latest},
        {"ground_altitude_m", "NAVIGATION_REF", "ground_alt", metre, Merge::latest},
    };
    return fields;
}

std::size_t order_of(const Track& track) {
    const auto& names = track_names();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), track.name) - names.begin());
}

/// All candidates of all tracks, in the order of track_names() and of preference.
std::vector<Track> logged_tracks(const telemetry::SenderLog& sender) {
    std::vector<Track> tracks;
    for (const auto& [name, message, field, quantity, merge] : field_tracks()) {
        const auto* table = sender.table(message);
        const auto* column = table == nullptr ? nullptr : table->column(field);
        if (column == nullptr || (quantity && column->quantity != quantity)) continue;
        tracks.push_back(make_candidate(name, fmt::format("{}.{}", message, field), *table, column->values, merge));
    }
    add_derived_tracks(tracks, sender);
    std::ranges::stable_sort(tracks, {}, order_of);
    return tracks;
}

void add_configuration(FlightSeries& series, const telemetry::TelemetryLog& log) {
    series.log_is_missing = !log.configuration;
    series.assumed_definitions = log.assumed_definitions;
    series.skipped = log.skipped;
    if (!log.configuration) return;
    series.start_clock_s = log.configuration->time_of_day_s;
    const auto found = log.configuration->aircraft.find(series.aircraft_id);
    if (found == log.configuration->aircraft.end()) return;
    const auto& aircraft = found->second;
    series.aircraft_name = aircraft.name;
    series.firmware = aircraft.firmware;
    series.block_names = aircraft.block_names;
    series.planned_ground_altitude_m = aircraft.ground_altitude_m;
    series.current_origin = aircraft.current_origin;
}

}  // namespace

std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender) {
    ClockFaults faults;
    for (const auto& table : sender.tables) add_faults(table, faults);
    const auto& first = faults.restart;
    if (faults.overlaps.size() < enough_late_rows) return first;
    std::ranges::sort(faults.overlaps, {},
                      [](const ClockRestart& at) { return std::tuple(at.visible_from_s, at.to_s, at.message); });
    const auto& shown = faults.overlaps[enough_late_rows - 1];
    return first && first->visible_from_s <= shown.visible_from_s ? first : shown;
}

std::vector<telemetry::MessageRequest> flight_messages() {
    return {
        {"ENERGY", {"throttle", "voltage", "bat", "current", "amp", "power", "charge", "energy"}},
        {"BAT", {"throttle", "voltage", "amps", "energy"}},
        {"ESC", {"amps", "bat_volts", "power", "rpm", "node_id", "motor_id"}},
        {"MOTOR", {"rpm"}},
        {"POWER_DEVICE", {"node_id", "circuit", "current", "voltage"}},
        {"COMMANDS", {"values[0]"}},
        {"ESTIMATOR", {"z", "z_dot"}},
        {"GPS", {"utm_east", "utm_north", "course", "alt", "speed", "climb", "utm_zone"}},
        {"GPS_INT", {"lat", "lon", "hmsl", "ecef_xd", "ecef_yd", "ecef_zd"}},
        {"GPS_LLA", {"lat", "lon"}},
        {"AIR_DATA", {"temp", "amsl_baro", "airspeed"}},
        {"AIRSPEED", {"airspeed"}},
        {"ROTORCRAFT_FP", {"east", "north", "up", "vup", "phi", "psi", "thrust"}},
        {"ATTITUDE", {"phi", "psi"}},
        {"NAVIGATION", {"cur_block", "pos_x", "pos_y"}},
        {"NAVIGATION_REF", {"ground_alt"}},
        {"PPRZ_MODE", {"ap_mode"}},
        {"ROVER_STATUS", {"ap_mode"}},
        {"TAKEOFF", {"cpu_time"}},
        {"WIND_INFO", {"east", "north"}},
    };
}

std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log) {
    const auto is_telemetry = [](const telemetry::MessageTable& table) {
        return table.message != "TAKEOFF" && table.message != "PPRZ_MODE" && table.message != "NAVIGATION_REF";
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
    const auto sender = std::ranges::find(log.senders, aircraft_id, &telemetry::SenderLog::id);
    if (sender == log.senders.end()) return series;
    series.clock_restart = find_clock_restart(*sender);
    series.tracks = logged_tracks(*sender);
    return series;
}

}  // namespace flightwatt::flight
