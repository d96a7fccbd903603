#include "base/units.h"
#include "flight/sources/log_family.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <regex>
#include <string>

#include <fmt/format.h>

/// Where ArduPilot's DataFlash logs have the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

using telemetry::MessageTable;
using Stored = FamilyField::Stored;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// Up to 3.2.1 the numbers of CURR are hundredths, which the log does not state; later they are floats.
const std::vector<FamilyField>& ardupilot_fields() {
    static const std::vector<FamilyField> fields{
        {"altitude_m", "BARO", "Alt", "m"},
        {"altitude_m", "CTUN", "BAlt", "m"},
        {"altitude_m", "CTUN", "BarAlt", "m"},
        {"altitude_m", "POS", "Alt", "m"},
        {"altitude_m", "GPS", "Alt", "m"},
        {"voltage_v", "BAT", "Volt", "V"},
        {"voltage_v", "CURR", "Volt", "V", Merge::mean, Stored::real},
        {"voltage_v", "CURR", "Volt", "0.01V", Merge::mean, Stored::integer},
        {"current_a", "BAT", "Curr", "A"},
        {"current_a", "CURR", "Curr", "A", Merge::mean, Stored::real},
        {"current_a", "CURR", "Curr", "0.01A", Merge::mean, Stored::integer},
        {"charge_ah", "BAT", "CurrTot", "mAh", Merge::latest},
        {"charge_ah", "CURR", "CurrTot", "mAh", Merge::latest},
        {"energy_wh", "BAT", "EnrgTot", "Wh", Merge::latest},
        {"ground_speed_m_per_s", "GPS", "Spd", "m/s"},
        {"airspeed_m_per_s", "ARSP", "Airspeed", "m/s"},
        {"wind_east_m_per_s", "XKF2", "VWE", "m/s"},
        {"wind_east_m_per_s", "NKF2", "VWE", "m/s"},
        {"wind_north_m_per_s", "XKF2", "VWN", "m/s"},
        {"wind_north_m_per_s", "NKF2", "VWN", "m/s"},
        {"latitude_deg", "GPS", "Lat", "deg", Merge::latest},
        {"longitude_deg", "GPS", "Lng", "deg", Merge::latest},
        {"heading_deg", "ATT", "Yaw", "deg", Merge::latest},
        {"course_deg", "GPS", "GCrs", "deg", Merge::latest},
        {"climb_m_per_s", "CTUN", "CRt", "m/s", Merge::mean, Stored::real},
        {"climb_m_per_s", "CTUN", "CRt", "cm/s", Merge::mean, Stored::integer},
        {"climb_m_per_s", "GPS", "VZ", "-1m/s"},
        {"roll_deg", "ATT", "Roll", "deg", Merge::latest},
        {"mode", "MODE", "ModeNum", "", Merge::latest},
        {"mode", "MODE", "Mode", "", Merge::latest},
        {"armed", "ARM", "ArmState", "", Merge::latest},
        {"armed", "STAT", "Armed", "", Merge::latest},
    };
    return fields;
}

/// Events of Copter that switch a state on and off.
struct Switch {
    const char* track;
    double on;
    double off;
};
constexpr Switch switches[] = {{"armed", 10.0, 11.0}, {"landed", 18.0, 28.0}};

void add_events(const FamilyLog& log, std::vector<Track>& tracks) {
    const auto* events = log.table("EV");
    const auto* ids = events == nullptr ? nullptr : events->column("Id");
    if (ids == nullptr) return;
    for (const auto& [track, on, off] : switches) {
        std::vector<double> values(ids->values.size());
        std::ranges::transform(ids->values, values.begin(), [&](double id) {
            return id == on ? 1.0 : id == off ? 0.0 : no_value;
        });
        if (std::ranges::any_of(values, [](double value) { return !std::isnan(value); }))
            add_track(tracks, track, "EV.Id", *events, values);
    }
}

/// The vehicle: "Copter" of "APM:Copter V3.4.4" and "ArduCopter V3.6.8"; empty if no message states it.
std::string vehicle_of(const telemetry::LogFacts& facts) {
    static const std::regex pattern("(?:Ardu|APM:)(Copter|Plane|Rover|Sub)\\b");
    for (const auto& text : facts.texts) {
        std::smatch found;
        if (std::regex_search(text, found, pattern)) return found[1];
    }
    return "";
}

/// Throttle at the motors: of Plane percent, of Copter a fraction, before 3.4 thousandths.
void add_throttle(const FamilyLog& log, std::vector<Track>& tracks) {
    const auto* table = log.table("CTUN");
    if (table == nullptr) return;
    const bool is_plane = vehicle_of(log.facts) == "Plane";
    constexpr double percent_per_thousandth = 0.1;
    for (const auto* field : {"ThO", "ThrOut"}) {
        const auto* column = table->column(field);
        if (column == nullptr) continue;
        const double factor = is_plane ? 1.0 : column->is_integer ? percent_per_thousandth : units::percent_per_whole;
        auto values = column->values;
        for (auto& value : values) value *= factor;
        add_track(tracks, "throttle_percent", fmt::format("CTUN.{}", field), *table, values, Merge::mean);
    }
}

void add_flying(const FamilyLog& log, std::vector<Track>& tracks) {
    const auto* table = log.table("STAT");
    const auto* flying = table == nullptr ? nullptr : table->column("isFlying");
    if (flying == nullptr) return;
    auto values = flying->values;
    for (auto& value : values) value = 1.0 - value;
    add_track(tracks, "landed", "STAT.isFlying", *table, values);
}

/// The serial number of the autopilot's board: "00310019 3138510E 35363631".
std::string board_of(const telemetry::LogFacts& facts) {
    static const std::regex pattern("([0-9A-F]{8}) ([0-9A-F]{8}) ([0-9A-F]{8})$");
    for (const auto& text : facts.texts) {
        std::smatch found;
        if (std::regex_search(text, found, pattern))
            return fmt::format("{}-{}-{}", found[1].str(), found[2].str(), found[3].str());
    }
    return "";
}

/// Unix time of the log's second 0, from the first GPS time.
std::optional<double> clock_of(const FamilyLog& log) {
    constexpr double gps_epoch_s = 315'964'800.0;
    constexpr double week_s = 604'800.0;
    constexpr double leap_s = 18.0;  // since 2017
    constexpr double leap_before_2017_s = 17.0;
    constexpr double year_2017_s = 1'483'228'800.0;
    const auto* gps = log.table("GPS");
    if (gps == nullptr) return std::nullopt;
    const auto* week = gps->column("GWk") != nullptr ? gps->column("GWk") : gps->column("Week");
    const auto* week_ms = gps->column("GMS") != nullptr ? gps->column("GMS") : gps->column("TimeMS");
    if (week == nullptr || week_ms == nullptr || !(week->values.front() > 0.0)) return std::nullopt;
    const double unix_s = gps_epoch_s + week->values.front() * week_s + week_ms->values.front() * units::milli;
    return unix_s - (unix_s < year_2017_s ? leap_before_2017_s : leap_s) - gps->time_s.front();
}

bool is_simulation(const FamilyLog& log) {
    if (log.table("SIM") != nullptr || log.table("SIM2") != nullptr) return true;
    return std::ranges::any_of(log.facts.texts,
                               [](const std::string& text) { return text.find("SITL") != std::string::npos; });
}

void describe_ardupilot(const FamilyLog& log, FlightSeries& series) {
    const auto vehicle = vehicle_of(log.facts);
    series.aircraft_id = board_of(log.facts);
    series.aircraft_name = vehicle.empty() ? "ArduPilot" : "Ardu" + vehicle;
    if (is_simulation(log)) series.aircraft_name += " SITL";
    series.firmware = vehicle == "Copter"  ? "rotorcraft"
                      : vehicle == "Plane" ? "fixedwing"
                      : vehicle == "Rover" ? "rover"
                                           : "";
    series.start_clock_s = clock_of(log);
}

}  // namespace

const LogFamily& ardupilot_family() {
    static const LogFamily family{ardupilot_fields(),
                                  {{"BAT", "Instance"},
                                   {"BAT", "Inst"},
                                   {"BARO", "I"},
                                   {"GPS", "I", "Status", 3.0},
                                   {"ARSP", "I"},
                                   {"XKF2", "C"},
                                   {"NKF2", "C"}},
                                  {{"voltage_v", "BAT", "Volt", "V"},
                                   {"current_a", "BAT", "Curr", "A"},
                                   {"voltage_v", "CURR", "Volt", "V", Merge::mean, Stored::real},
                                   {"current_a", "CURR", "Curr", "A", Merge::mean, Stored::real},
                                   {"voltage_v", "CURR", "Volt", "0.01V", Merge::mean, Stored::integer},
                                   {"current_a", "CURR", "Curr", "0.01A", Merge::mean, Stored::integer}},
                                  {{"CTUN", {"ThO", "ThrOut"}},
                                   {"EV", {"Id"}},
                                   {"STAT", {"isFlying"}},
                                   {"GPS", {"GWk", "GMS", "Week", "TimeMS"}},
                                   {"SIM", {"Alt"}},
                                   {"SIM2", {"PD"}}},
                                  [](const FamilyLog& log, std::vector<Track>& tracks) {
                                      add_throttle(log, tracks);
                                      add_events(log, tracks);
                                      add_flying(log, tracks);
                                  },
                                  describe_ardupilot,
                                  true};
    return family;
}

}  // namespace flightwatt::flight
