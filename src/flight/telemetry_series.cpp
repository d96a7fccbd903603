#include "flight/telemetry_series.h"

#include "base/units.h"
#include "flight/families/derived_tracks.h"
#include "flight/families/log_family.h"
#include "flight/families/mavlink_family.h"
#include "telemetry/recordings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double week_s = 604'800.0;
constexpr double restart_s = 60.0;
constexpr double late_s = 2.0;       // more than rows that wait for others in a logger's buffer
constexpr double step_late_s = 0.5;  // of rows between those of the same message that lack none
constexpr std::size_t enough_late_rows = 10;
constexpr std::size_t few_late_rows = 3;
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

/// Several devices report at one time and in any order.
bool may_overlap(const telemetry::MessageTable& table) {
    return table.message != "ESC" && table.message != "POWER_DEVICE";
}

/// A clock that was set back, and the rows behind it, in order, between times that rows before them have already.
struct ClockStep {
    double from_s = 0.0;
    double to_s = 0.0;
    std::size_t rows = 0;
};

/// The step with most such rows. Lines out of order fill holes instead, and repeated lines are equal.
ClockStep largest_step(const telemetry::MessageTable& table) {
    const auto& times_s = table.time_s;
    auto intervals_s = times_s;
    std::ranges::sort(intervals_s);
    std::adjacent_difference(intervals_s.begin(), intervals_s.end(), intervals_s.begin());
    const auto low = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 10);
    std::nth_element(intervals_s.begin(), low, intervals_s.end());
    const double close_s = hole_intervals * *low;
    ClockStep largest;
    ClockStep step;
    std::map<double, std::size_t> seen;
    bool is_behind = false;
    for (std::size_t row = 0; row < times_s.size(); ++row) {
        const double time_s = times_s[row];
        const double latest_s = seen.empty() ? time_s : seen.rbegin()->first;
        is_behind = is_behind && time_s >= times_s[row - 1] && time_s <= step.from_s;
        if (!is_behind && latest_s - time_s > step_late_s) step = {latest_s, time_s, 0}, is_behind = true;
        const auto above = seen.lower_bound(time_s);
        if (is_behind && above->first == time_s)
            step.rows += differ(table, row, above->second) ? 1 : 0;
        else if (is_behind && above != seen.begin() && above->first - std::prev(above)->first < close_s)
            ++step.rows;
        if (step.rows > largest.rows) largest = step;
        seen.emplace(time_s, row);
    }
    return largest;
}

/// Restarts and overlapping rows of one message.
struct ClockFaults {
    std::optional<ClockRestart> restart;
    std::vector<ClockRestart> overlaps;
};

void add_faults(const telemetry::MessageTable& table, ClockFaults& faults) {
    if (!has_late_rows(table, late_s)) return;
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
        if (may_overlap(table) && std::isfinite(known_s) && is_overlap(table, row, seen, known_s))
            faults.overlaps.push_back({known_s, seen.rbegin()->first, time_s, table.message});
        seen.emplace(time_s, SeenRow{row, known_s});
    }
}

/// 0 east and 0 north: the aircraft does not know the wind yet.
double wind_speed(const std::vector<double>& east_north) {
    const double speed = std::hypot(east_north[0], east_north[1]);
    return speed > 0.0 ? speed : std::numeric_limits<double>::quiet_NaN();
}

double speed_of_components(const std::vector<double>& row) { return std::hypot(row[0], row[1], row[2]); }

double percent_of_command(const std::vector<double>& row) { return units::percent_from_pprz(row[0]); }

double utm_latitude_deg(const std::vector<double>& row) { return position_from_utm(row).first; }
double utm_longitude_deg(const std::vector<double>& row) { return position_from_utm(row).second; }

const LogFamily& paparazzi_family() {
    constexpr auto mean = Merge::mean;
    constexpr auto latest = Merge::latest;
    const FamilySource voltage{"voltage", "V"};
    const FamilySource current{"current", "A"};
    const std::vector<FamilySource> ecef{{"ecef_xd"}, {"ecef_yd"}, {"ecef_zd"}};
    const std::vector<FamilySource> wind{{"east", "m/s"}, {"north"}};
    const std::vector<FamilySource> utm{{"utm_east"}, {"utm_north"}, {"utm_zone"}};
    static const LogFamily family{
        {
            {"throttle_percent", "ENERGY", {{"throttle", "%"}}},
            {"throttle_percent", "BAT", {{"throttle", "%"}}},
            {"voltage_v", "ENERGY", {{"voltage", "V"}}},
            {"voltage_v", "ENERGY", {{"bat", "V"}}},
            {"voltage_v", "BAT", {{"voltage", "V"}}},
            {"voltage_v", "ESC", {{"bat_volts", "V"}}},
            {"voltage_v", "POWER_DEVICE", {{"voltage", "V"}}},
            {"current_a", "ENERGY", {{"current", "A"}}},
            {"current_a", "ENERGY", {{"amp", "A"}}},
            {"current_a", "BAT", {{"amps", "A"}}},
            {"power_w", "ENERGY", {{"power", "W"}}},
            {"power_w", "ENERGY", {voltage, current}, mean, product},
            {"power_w", "ENERGY", {voltage, {"amp", "A"}}, mean, product},
            {"power_w", "ENERGY", {{"bat", "V"}, current}, mean, product},
            {"power_w", "ENERGY", {{"bat", "V"}, {"amp", "A"}}, mean, product},
            {"power_w", "BAT", {voltage, {"amps", "A"}}, mean, product},
            {"charge_ah", "ENERGY", {{"charge", "Ah"}}, latest},
            {"charge_ah", "ENERGY", {{"energy", "Ah"}}, latest},
            {"charge_ah", "BAT", {{"energy", "Ah"}}, latest},
            {"energy_wh", "ENERGY", {{"energy", "Wh"}}, latest},
            {"altitude_m", "ESTIMATOR", {{"z", "m"}}},
            {"altitude_m", "ROTORCRAFT_FP", {{"up", "m"}}},
            {"altitude_m", "GPS", {{"alt", "m"}}},
            {"altitude_m", "GPS_INT", {{"hmsl", "m"}}},
            {"altitude_m", "AIR_DATA", {{"amsl_baro", "m"}}},
            {"east_m", "NAVIGATION", {{"pos_x", "m"}}},
            {"east_m", "ROTORCRAFT_FP", {{"east", "m"}}},
            {"east_m", "GPS", {{"utm_east", "m"}}},
            {"north_m", "NAVIGATION", {{"pos_y", "m"}}},
            {"north_m", "ROTORCRAFT_FP", {{"north", "m"}}},
            {"north_m", "GPS", {{"utm_north", "m"}}},
            {"ground_speed_m_per_s", "GPS", {{"speed", "m/s"}}},
            {"airspeed_m_per_s", "AIRSPEED", {{"airspeed", "m/s"}}},
            {"airspeed_m_per_s", "AIR_DATA", {{"airspeed", "m/s"}}},
            {"wind_east_m_per_s", "WIND_INFO", {{"east", "m/s"}}},
            {"wind_north_m_per_s", "WIND_INFO", {{"north", "m/s"}}},
            {"latitude_deg", "GPS_INT", {{"lat", "deg"}}, latest},
            {"latitude_deg", "GPS_LLA", {{"lat", "deg"}}, latest},
            {"longitude_deg", "GPS_INT", {{"lon", "deg"}}, latest},
            {"longitude_deg", "GPS_LLA", {{"lon", "deg"}}, latest},
            {"heading_deg", "ATTITUDE", {{"psi", "deg"}}, latest},
            {"heading_deg", "ROTORCRAFT_FP", {{"psi", "deg"}}, latest},
            {"course_deg", "GPS", {{"course", "deg"}}, latest},
            {"climb_m_per_s", "ESTIMATOR", {{"z_dot", "m/s"}}},
            {"climb_m_per_s", "ROTORCRAFT_FP", {{"vup", "m/s"}}},
            {"climb_m_per_s", "GPS", {{"climb", "m/s"}}},
            {"roll_deg", "ATTITUDE", {{"phi", "deg"}}, latest},
            {"roll_deg", "ROTORCRAFT_FP", {{"phi", "deg"}}, latest},
            {"air_temperature_c", "AIR_DATA", {{"temp", "celsius"}}},
            {"motor_speed_rpm", "ESC", {{"rpm"}}},
            {"mode", "PPRZ_MODE", {{"ap_mode"}}, latest},
            {"block", "NAVIGATION", {{"cur_block"}}, latest},
            {"rover_mode", "ROVER_STATUS", {{"ap_mode"}}, latest},
            {"fix", "GPS", {{"mode"}}, latest},
            {"fix", "GPS_INT", {{"fix"}}, latest},
            {"ground_altitude_m", "NAVIGATION_REF", {{"ground_alt", "m"}}, latest},
            // Rotorcraft before 2018: thrust, without a unit, on Paparazzi's command scale.
            {"throttle_percent", "ROTORCRAFT_FP", {{"thrust"}}, mean, percent_of_command},
            // Command to the motor, also in manual mode.
            {"throttle_percent", "COMMANDS", {{"values"}}, mean, percent_of_command, nullptr, commanded_throttle},
            {"motor_speed_rpm", "MOTOR", {{"rpm"}}, mean, [](const auto& hertz) { return hertz[0] * 60.0; }},
            {"ground_speed_m_per_s", "GPS_INT", ecef, mean, speed_of_components, nullptr, "GPS_INT.ecef velocity"},
            {"wind_speed_m_per_s", "WIND_INFO", wind, mean, wind_speed, nullptr, "WIND_INFO.east, north"},
            {"latitude_deg", "GPS", utm, mean, utm_latitude_deg, nullptr, "GPS.utm"},
            {"longitude_deg", "GPS", utm, mean, utm_longitude_deg, nullptr, "GPS.utm"},
        },
        {{"GPS", nullptr, "mode", min_fix}, {"GPS_INT", nullptr, "fix", min_fix}},
        nullptr,
        {{"ESC", {"amps", "power", "node_id", "motor_id"}},
         {"POWER_DEVICE", {"node_id", "circuit", "current"}},
         {"TAKEOFF", {"cpu_time"}}},
        LogFamily::Unstated::unused};
    return family;
}

/// All candidates of all tracks, in the order of track_names() and of preference.
std::vector<Track> logged_tracks(const telemetry::SenderLog& sender) {
    std::vector<Track> tracks;
    add_family_tracks(sender, paparazzi_family(), "", tracks);
    add_derived_tracks(tracks, sender);
    sort_tracks(tracks);
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

/// Sets the Unix time of the log's second 0, by the first time before 2100.
void set_start_clock(FlightSeries& series) {
    constexpr double last_s = 4'102'444'800.0;  // 2100
    for (const auto& track : series.tracks) {
        for (std::size_t i = 0; track.name == utc_track && i < track.value.size(); ++i) {
            const double utc_s = correct_week_rollover(track.value[i]);
            if (!(utc_s < last_s)) continue;
            series.start_clock_s = utc_s - track.time_s[i];
            if (utc_s != track.value[i])
                series.notes.push_back(
                    fmt::format("the date of {} is {:.0f} weeks too early, as its counter of weeks "
                                "overflowed: they are added",
                                track.source, (utc_s - track.value[i]) / week_s));
            return;
        }
    }
}

/// Finds the rows of a clock that was set back by seconds and passes the same times again, too few for a restart;
/// std::nullopt without any.
std::optional<telemetry::SkippedLines> find_clock_step(const telemetry::SenderLog& sender) {
    ClockStep largest;
    std::size_t rows = 0;
    for (const auto& table : sender.tables) {
        if (!may_overlap(table) || !has_late_rows(table, step_late_s)) continue;
        const auto step = largest_step(table);
        rows += step.rows;
        if (step.rows > largest.rows) largest = step;
    }
    if (rows < few_late_rows) return std::nullopt;
    return telemetry::SkippedLines{
        fmt::format("the clock is set back by {:.1f} s at {:.1f} s, so that times occur twice",
                    largest.from_s - largest.to_s, largest.from_s),
        {{largest.from_s, rows, 0}}};
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

std::vector<telemetry::TelemetryLog> recordings_of(telemetry::TelemetryLog log) {
    return telemetry::split_recordings(std::move(log),
                                       [](const auto& rows) { return find_clock_restart(rows).has_value(); });
}

std::vector<telemetry::MessageRequest> flight_messages() {
    auto requests = family_messages(paparazzi_family());
    std::ranges::find(requests, "COMMANDS", &telemetry::MessageRequest::message)->fields = {"values[0]"};
    return requests;
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
    if (auto step = find_clock_step(*sender)) series.skipped.push_back(*std::move(step));
    series.tracks = logged_tracks(*sender);
    return series;
}

std::vector<telemetry::MessageRequest> mavlink_flight_messages() { return family_messages(mavlink_family()); }

FlightSeries mavlink_series(telemetry::AutopilotLog log) {
    return family_series(without_doubtful_messages(std::move(log)), mavlink_family());
}

FlightSeries family_series(telemetry::AutopilotLog read, const LogFamily& family) {
    FlightSeries series;
    auto& log = read.log;
    const auto& sender = log.senders.front();
    series.file = log.data_file.string();
    series.flight = log.flight;
    series.skipped = std::move(log.skipped);
    series.current_origin = CurrentOrigin::sensor;
    series.clock_restart = find_clock_restart(sender);
    if (auto step = find_clock_step(sender)) series.skipped.push_back(*std::move(step));
    family.describe(read, series);
    const auto is_synthetic_text = [](const std::string& text) { return text.find("SYNTHETIC:") != std::string::npos; };
    if (std::ranges::any_of(read.facts.texts, is_synthetic_text)) series.aircraft_name += "_synthetic";
    const auto assumed = add_family_tracks(sender, family, series.firmware, series.tracks);
    set_start_clock(series);
    std::erase_if(series.tracks, [](const Track& track) { return track.name == utc_track; });
    sort_tracks(series.tracks);
    if (family.unstated_units == LogFamily::Unstated::noted && !assumed.empty())
        series.notes.push_back(fmt::format("the log states no units: {}", fmt::join(assumed, ", ")));
    if (read.facts.dropouts > 0)
        series.notes.push_back(fmt::format("the logger lost data {} times, for {:.1f} s in all", read.facts.dropouts,
                                           read.facts.dropout_s));
    return series;
}

}  // namespace flightwatt::flight
