#include "base/units.h"
#include "flight/sources/log_family.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

/// Where ArduPilot's DataFlash logs have the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// 1 and 0 of events that switch a state on and off.
template <int on, int off>
double switched(const std::vector<double>& id) {
    return id[0] == on ? 1.0 : id[0] == off ? 0.0 : no_value;
}

/// Unix time of a GPS week and its milliseconds, less leap seconds.
double utc_of_gps(const std::vector<double>& row) {
    constexpr double gps_epoch_s = 315'964'800.0;
    constexpr double week_s = 604'800.0;
    constexpr double year_2017_s = 1'483'228'800.0;
    constexpr double july_2015_s = 1'435'708'800.0;
    constexpr double leap_s = 16.0;  // from July 2012 on
    const double utc_s = gps_epoch_s + row[0] * week_s + row[1] * units::milli - leap_s;
    return row[0] > 0.0 ? utc_s - (utc_s > july_2015_s ? 1.0 : 0.0) - (utc_s > year_2017_s ? 1.0 : 0.0) : no_value;
}

// Up to 3.2.1 the whole numbers of CURR are hundredths, which the log does not state; later they are floats.
const std::vector<FamilyTrack>& ardupilot_tracks() {
    constexpr auto latest = Merge::latest;
    static const std::vector<FamilyTrack> tracks{
        {"power_w", "BAT", {{"Volt", "V"}, {"Curr", "A"}}, Merge::mean, product},
        {"power_w", "CURR", {{"Volt", "V", "0.01V"}, {"Curr", "A", "0.01A"}}, Merge::mean, product},
        {"altitude_m", "BARO", {{"Alt", "m"}}},
        {"altitude_m", "CTUN", {{"BAlt", "m"}}},
        {"altitude_m", "CTUN", {{"BarAlt", "m"}}},
        {"altitude_m", "POS", {{"Alt", "m"}}},
        {"altitude_m", "GPS", {{"Alt", "m"}}},
        {"voltage_v", "BAT", {{"Volt", "V"}}},
        {"voltage_v", "CURR", {{"Volt", "V", "0.01V"}}},
        {"current_a", "BAT", {{"Curr", "A"}}},
        {"current_a", "CURR", {{"Curr", "A", "0.01A"}}},
        {"charge_ah", "BAT", {{"CurrTot", "mAh"}}, latest},
        {"charge_ah", "CURR", {{"CurrTot", "mAh"}}, latest},
        {"energy_wh", "BAT", {{"EnrgTot", "Wh"}}, latest},
        {"ground_speed_m_per_s", "GPS", {{"Spd", "m/s"}}},
        {"airspeed_m_per_s", "ARSP", {{"Airspeed", "m/s"}}},
        {"wind_east_m_per_s", "XKF2", {{"VWE", "m/s"}}},
        {"wind_east_m_per_s", "NKF2", {{"VWE", "m/s"}}},
        {"wind_north_m_per_s", "XKF2", {{"VWN", "m/s"}}},
        {"wind_north_m_per_s", "NKF2", {{"VWN", "m/s"}}},
        {"latitude_deg", "GPS", {{"Lat", "deg"}}, latest},
        {"longitude_deg", "GPS", {{"Lng", "deg"}}, latest},
        {"heading_deg", "ATT", {{"Yaw", "deg"}}, latest},
        {"course_deg", "GPS", {{"GCrs", "deg"}}, latest},
        {"climb_m_per_s", "CTUN", {{"CRt", "m/s", "cm/s"}}},
        {"climb_m_per_s", "GPS", {{"VZ", "-1m/s"}}},
        {"roll_deg", "ATT", {{"Roll", "deg"}}, latest},
        {"throttle_percent", "CTUN", {{"ThO", "%"}}, Merge::mean, nullptr, "fixedwing"},
        {"throttle_percent", "CTUN", {{"ThrOut", "%"}}, Merge::mean, nullptr, "fixedwing"},
        {"throttle_percent", "CTUN", {{"ThO", "100%", "0.1%"}}, Merge::mean, nullptr, "rotorcraft"},
        {"throttle_percent", "CTUN", {{"ThrOut", "100%", "0.1%"}}, Merge::mean, nullptr, "rotorcraft"},
        {utc_track, "GPS", {{"GWk"}, {"GMS"}}, latest, utc_of_gps},
        {utc_track, "GPS", {{"Week"}, {"TimeMS"}}, latest, utc_of_gps},
        {"mode", "MODE", {{"ModeNum"}}, latest},
        {"mode", "MODE", {{"Mode"}}, latest},
        {"armed", "ARM", {{"ArmState"}}, latest},
        {"armed", "STAT", {{"Armed"}}, latest},
        {"armed", "EV", {{"Id"}}, latest, switched<10, 11>},
        {"landed", "EV", {{"Id"}}, latest, switched<18, 28>},
        {"landed", "STAT", {{"isFlying"}}, latest, [](const auto& flying) { return 1.0 - flying[0]; }},
        {"fix", "GPS", {{"Status"}}, latest},
    };
    return tracks;
}

/// The first group of the first text that has the pattern.
std::string found_in_texts(const telemetry::LogFacts& facts, const char* pattern) {
    const std::regex expression(pattern);
    for (const auto& text : facts.texts) {
        std::smatch found;
        if (std::regex_search(text, found, expression)) return found[1];
    }
    return "";
}

void describe_ardupilot(const telemetry::AutopilotLog& log, FlightSeries& series) {
    // "APM:Copter V3.4.4", "ArduCopter V3.6.8"; the serial number of the board is "00310019 3138510E 35363631"
    const auto vehicle = found_in_texts(log.facts, "(?:Ardu|APM:)(Copter|Plane|Rover|Sub)\\b");
    series.aircraft_id = found_in_texts(log.facts, "([0-9A-F]{8} [0-9A-F]{8} [0-9A-F]{8})$");
    std::ranges::replace(series.aircraft_id, ' ', '-');
    series.aircraft_name = vehicle.empty() ? "ArduPilot" : "Ardu" + vehicle;
    const bool is_simulated =
        !found_in_texts(log.facts, "(SITL)").empty() ||
        std::ranges::any_of(log.messages, [](const auto& of) { return of.name == "SIM" || of.name == "SIM2"; });
    if (is_simulated) series.aircraft_name += " SITL";
    series.firmware = vehicle == "Copter"  ? "rotorcraft"
                      : vehicle == "Plane" ? "fixedwing"
                      : vehicle == "Rover" ? "rover"
                                           : "";
}

}  // namespace

const LogFamily& ardupilot_family() {
    static const LogFamily family{ardupilot_tracks(),
                                  {{"BAT", "Instance"},
                                   {"BAT", "Inst"},
                                   {"BARO", "I"},
                                   {"GPS", "I", "Status", min_fix},
                                   {"ARSP", "I"},
                                   {"XKF2", "C"},
                                   {"NKF2", "C"}},
                                  describe_ardupilot,
                                  {},
                                  LogFamily::Unstated::noted};
    return family;
}

}  // namespace flightwatt::flight
