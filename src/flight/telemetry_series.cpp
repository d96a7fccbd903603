#include "flight/telemetry_series.h"

#include "base/parallel.h"
#include "base/units.h"
#include "flight/sources/derived_tracks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>
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

/// A jump back of a minute is another log, or another boot, behind the first one. Of all that show it, the pair of
/// times that shows it first.
std::optional<ClockRestart> restart_in(const telemetry::MessageTable& table) {
    std::optional<ClockRestart> restart;
    if (!has_late_rows(table, restart_s)) return restart;
    std::set<double> seen_s;
    for (const double time_s : table.time_s) {
        const auto first = seen_s.upper_bound(time_s + restart_s);
        if (first != seen_s.end() && (!restart || *first < restart->visible_from_s)) {
            restart = {*first, *seen_s.rbegin(), time_s, table.message};
        }
        seen_s.insert(time_s);
    }
    return restart;
}

/// A row that came before in the file, and the earliest time that shows it to be late (infinite: none).
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

/// Whether a row lies where the rows before it in the file lack none. It looks at nothing later than `known_s`, so that
/// a log which ends there shows the same.
bool lies_over(const telemetry::MessageTable& table, std::size_t row, const SeenRows& seen, double known_s) {
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

void add_overlaps(const telemetry::MessageTable& table, std::vector<ClockRestart>& overlaps) {
    if (!has_late_rows(table, late_s)) return;
    SeenRows seen;
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        const double time_s = table.time_s[row];
        const auto shows_late = seen.upper_bound(time_s + late_s);
        const double known_s = shows_late == seen.end() ? std::numeric_limits<double>::infinity() : shows_late->first;
        if (std::isfinite(known_s) && lies_over(table, row, seen, known_s))
            overlaps.push_back({known_s, known_s, time_s, table.message});
        seen.emplace(time_s, SeenRow{row, known_s});
    }
}

using units::Quantity;

/// A field that is a track as it stands.
struct FieldTrack {
    const char* name;
    const char* message;
    const char* field;
    std::optional<Quantity> quantity;  ///< that the field must have
    Merge merge;
};

/// In the order of preference; of different names the order does not matter.
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

std::size_t place_of(const Track& track) {
    const auto& names = track_names();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), track.name) - names.begin());
}

/// A short log is read before another thread has begun.
std::size_t threads_worth(const telemetry::SenderLog& sender) {
    constexpr std::size_t few_rows = 100'000;
    std::size_t rows = 0;
    for (const auto& table : sender.tables) rows += table.time_s.size();
    return rows < few_rows ? 1 : 0;
}

/// A field that the sender's log has, for a track.
template <typename Table, typename Column>
struct LoggedField {
    const FieldTrack* wanted;
    Table* table;
    Column* column;
};

template <typename Sender>
auto logged_fields(Sender& sender) {
    using Table = std::remove_reference_t<decltype(sender.tables.front())>;
    using Column = std::remove_reference_t<decltype(sender.tables.front().columns.front())>;
    std::vector<LoggedField<Table, Column>> found;
    for (const auto& wanted : field_tracks()) {
        const auto table = std::ranges::find(sender.tables, wanted.message, &telemetry::MessageTable::message);
        if (table == sender.tables.end()) continue;
        const auto column = std::ranges::find(table->columns, wanted.field, &telemetry::Column::field);
        if (column == table->columns.end() || (wanted.quantity && column->quantity != wanted.quantity)) continue;
        found.push_back({&wanted, &*table, &*column});
    }
    return found;
}

/// Every candidate of every track that the sender's messages tell, in the order of track_names() and of preference. The
/// columns of a sender that is not const go into the tracks: a field is at most one of them as it stands, since its
/// quantity says which.
template <typename Sender>
std::vector<Track> logged_tracks(Sender& sender, bool definitions_assumed) {
    std::vector<Track> made;
    add_derived_tracks(made, sender, definitions_assumed);
    const auto fields = logged_fields(sender);
    std::vector<Track> tracks(fields.size());
    for_each_in_parallel(
        fields.size(),
        [&](std::size_t i) {
            const auto& [wanted, table, column] = fields[i];
            tracks[i] = make_candidate(wanted->name, fmt::format("{}.{}", wanted->message, wanted->field), *table,
                                       std::move(column->values), wanted->merge);
        },
        threads_worth(sender));
    std::ranges::move(made, std::back_inserter(tracks));
    std::ranges::stable_sort(tracks, {}, place_of);
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

/// The columns of a log that is not const go into the tracks.
template <typename Log>
FlightSeries make_series(Log& log, const std::string& aircraft_id) {
    FlightSeries series;
    series.file = log.data_file.string();
    series.flight = log.flight;
    series.aircraft_id = aircraft_id;
    add_configuration(series, log);
    const auto sender = std::ranges::find(log.senders, aircraft_id, &telemetry::SenderLog::id);
    if (sender == log.senders.end()) return series;
    series.clock_restart = find_clock_restart(*sender);
    series.tracks = logged_tracks(*sender, series.log_is_missing);
    return series;
}

}  // namespace

std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender) {
    std::optional<ClockRestart> first;
    std::vector<ClockRestart> overlaps;
    for (const auto& table : sender.tables) {
        const auto restart = restart_in(table);
        if (restart && (!first || restart->visible_from_s < first->visible_from_s)) first = restart;
        // Several devices report at one time and in any order.
        if (table.message != "ESC" && table.message != "POWER_DEVICE") add_overlaps(table, overlaps);
    }
    if (overlaps.size() < enough_late_rows) return first;
    std::ranges::sort(overlaps, {},
                      [](const ClockRestart& at) { return std::tuple(at.visible_from_s, at.to_s, at.message); });
    const auto& shown = overlaps[enough_late_rows - 1];
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
    return make_series(log, aircraft_id);
}

FlightSeries extract_flight_series(telemetry::TelemetryLog& log, const std::string& aircraft_id) {
    return make_series(log, aircraft_id);
}

}  // namespace flightwatt::flight
