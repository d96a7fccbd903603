#include "flight/families/ardupilot_family.h"

#include "base/units.h"
#include "flight/families/derived_tracks.h"

#include <algorithm>
#include <optional>
#include <regex>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

/// Where ArduPilot's DataFlash logs have the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

constexpr double is_true = 1.0;  // of flags: an airspeed sensor is used, a sensor is healthy

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
    if (!(row[0] > 0.0)) return no_value;
    const double utc_s = gps_epoch_s + row[0] * week_s + row[1] * units::milli - leap_s;
    const double date_s = correct_week_rollover(utc_s);
    return utc_s - (date_s > july_2015_s ? 1.0 : 0.0) - (date_s > year_2017_s ? 1.0 : 0.0);
}

/// A battery monitor: BAT with instances, or BAT2 and CUR2 of 3.4 to 4.0. Up to 3.2.1 the whole numbers of CURR are
/// hundredths, which the log does not state; later they are floats.
void add_monitor(const char* message, const char* device, std::vector<FamilyTrack>& tracks) {
    constexpr auto mean = Merge::mean;
    constexpr auto latest = Merge::latest;
    const FamilySource voltage{"Volt", "V", "0.01V"};
    const FamilySource current{"Curr", "A", "0.01A"};
    const FamilySource temperature{"Temp", "degC"};
    tracks.insert(
        tracks.end(),
        {{"power_w", message, {voltage, current}, mean, product, nullptr, nullptr, device},
         {"voltage_v", message, {voltage}, mean, nullptr, nullptr, nullptr, device},
         {"current_a", message, {current}, mean, nullptr, nullptr, nullptr, device},
         {"charge_ah", message, {{"CurrTot", "mAh"}}, latest, nullptr, nullptr, nullptr, device},
         {"energy_wh", message, {{"EnrgTot", "Wh"}}, latest, nullptr, nullptr, nullptr, device},
         {"battery_temperature_c", message, {temperature}, mean, if_stated_temperature, nullptr, nullptr, device}});
}

/// An ESC: ESC with instances, or ESC1 to ESC8 until 4.0.
void add_esc(const char* message, const char* device, std::vector<FamilyTrack>& tracks) {
    constexpr auto mean = Merge::mean;
    const FamilySource voltage{"Volt", "V"};
    const FamilySource current{"Curr", "A"};
    tracks.insert(tracks.end(), {{"power_w", message, {voltage, current}, mean, product, nullptr, "ESC", device},
                                 {"voltage_v", message, {voltage}, mean, nullptr, nullptr, "ESC.Volt", device},
                                 {"current_a", message, {current}, mean, nullptr, nullptr, "ESC.Curr", device}});
}

std::vector<FamilyTrack> electrical_tracks() {
    std::vector<FamilyTrack> tracks;
    for (const auto& [message, device] :
         {std::pair<const char*, const char*>{"BAT", nullptr}, {"CURR", nullptr}, {"BAT2", "1"}, {"CUR2", "1"}})
        add_monitor(message, device, tracks);
    add_esc("ESC", nullptr, tracks);
    for (const char* message : {"ESC1", "ESC2", "ESC3", "ESC4", "ESC5", "ESC6", "ESC7", "ESC8"})
        add_esc(message, message + std::string_view("ESC").size(), tracks);
    return tracks;
}

std::vector<FamilyTrack> ardupilot_tracks() {
    constexpr auto latest = Merge::latest;
    auto tracks = electrical_tracks();
    tracks.insert(tracks.end(),
                  {
                      {"altitude_m", "BARO", {{"Alt", "m"}}},
                      {"altitude_m", "CTUN", {{"BAlt", "m"}}},
                      {"altitude_m", "CTUN", {{"BarAlt", "m"}}},
                      {"altitude_m", "POS", {{"Alt", "m"}}},
                      {"altitude_m", "GPS", {{"Alt", "m"}}},
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
                      {"climb_m_per_s", "CTUN", {{"CRate", "m/s", "cm/s"}}},
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
                      {"vtol_state", "QTUN", {{"ThO"}}, latest, lift_motors_run},
                  });
    return tracks;
}

/// The first group of the first text that has the pattern.
std::string found_in_texts(const telemetry::LogFacts& facts, const std::regex& pattern) {
    for (const auto& text : facts.texts) {
        std::smatch found;
        if (std::regex_search(text, found, pattern)) return found[1];
    }
    return "";
}

/// The number of motors by the frame; std::nullopt for helicopters and others.
std::optional<double> motors_of(const std::map<std::string, double>& parameters) {
    static const std::map<double, double> motors{{1, 4}, {2, 6}, {3, 8}, {4, 8}, {5, 6}, {7, 3}, {12, 12}, {14, 10}};
    const auto quadplane = parameters.find("Q_ENABLE");
    const bool is_quadplane = quadplane != parameters.end() && quadplane->second > 0.0;
    const auto frame = parameters.find(is_quadplane ? "Q_FRAME_CLASS" : "FRAME_CLASS");
    const auto found = frame == parameters.end() ? motors.end() : motors.find(frame->second);
    return found == motors.end() ? std::nullopt : std::optional(found->second);
}

/// The kind of vehicle by the number of its software; empty if no parameter states it.
std::string vehicle_of_parameters(const std::map<std::string, double>& parameters) {
    static const std::map<double, std::string> vehicles{
        {0.0, "Plane"}, {10.0, "Copter"}, {20.0, "Rover"}, {40.0, "Sub"}};
    const auto type = parameters.find("SYSID_SW_TYPE");
    const auto found = type == parameters.end() ? vehicles.end() : vehicles.find(type->second);
    return found == vehicles.end() ? "" : found->second;
}

void describe_ardupilot(const telemetry::AutopilotLog& log, FlightSeries& series) {
    // "APM:Copter V3.4.4", "ArduCopter V3.6.8", "APMrover2 v2.50"
    static const std::regex vehicles("(?:Ardu|APM:)(Copter|Plane|Rover|Sub)\\b");
    static const std::regex rovers("APM(rover)");
    static const std::regex simulators("(SITL)");
    auto vehicle = found_in_texts(log.facts, vehicles);
    if (!found_in_texts(log.facts, rovers).empty()) vehicle = "Rover";
    if (vehicle.empty()) vehicle = vehicle_of_parameters(log.facts.parameters);
    series.aircraft_id = board_serial(log.facts);
    series.aircraft_name = vehicle.empty() ? "ArduPilot" : "Ardu" + vehicle;
    add_monitor_kinds(log.facts.parameters, series);
    series.motors = motors_of(log.facts.parameters);
    series.monitor_capacities_ah = monitor_capacities_ah(log.facts.parameters, {"BATT_CAPACITY"}, "BATTN_CAPACITY");
    series.pack_serial = pack_serials(log.facts.parameters);
    const bool is_simulated =
        !found_in_texts(log.facts, simulators).empty() ||
        std::ranges::any_of(log.messages, [](const auto& of) { return of.name == "SIM" || of.name == "SIM2"; });
    if (is_simulated) series.aircraft_name += " SITL";
    series.firmware = vehicle == "Copter"  ? "rotorcraft"
                      : vehicle == "Plane" ? "fixedwing"
                      : vehicle == "Rover" ? "rover"
                                           : "";
}

constexpr int max_monitors = 9;

/// A parameter of a battery monitor, by its number from 1 on: "BATT2_MONITOR".
std::optional<double> monitor_parameter(const std::map<std::string, double>& parameters, int number, const char* name) {
    const auto found =
        parameters.find(number == 1 ? fmt::format("BATT_{}", name) : fmt::format("BATT{}_{}", number, name));
    return found == parameters.end() ? std::nullopt : std::optional(found->second);
}

/// The pins of an analog monitor of voltage and current.
std::optional<std::pair<double, double>> analog_pins(const std::map<std::string, double>& parameters, int number) {
    constexpr double analog_voltage_and_current = 4.0;
    const auto volt = monitor_parameter(parameters, number, "VOLT_PIN");
    const auto curr = monitor_parameter(parameters, number, "CURR_PIN");
    if (monitor_parameter(parameters, number, "MONITOR") != analog_voltage_and_current || !volt || !curr)
        return std::nullopt;
    return std::pair(*volt, *curr);
}

/// The serial number of a smart battery, where it is stated.
std::optional<double> smart_serial(const std::map<std::string, double>& parameters, int number) {
    const std::set<double> smart{5.0,  7.0,  8.0, 13.0,
                                 14.0, 16.0, 19.0};  // Solo, SMBus, DroneCAN, SUI3, SUI6, Maxell, Rotoye
    const auto kind = monitor_parameter(parameters, number, "MONITOR");
    const auto serial = monitor_parameter(parameters, number, "SERIAL_NUM");
    return kind && smart.contains(*kind) && serial && *serial >= 0.0 ? serial : std::nullopt;
}

/// Adds monitors with the pins of an earlier one, and smart batteries that differ in their serial numbers.
void add_known_packs(const std::map<std::string, double>& parameters, std::map<std::string, std::string>& kinds) {
    std::set<std::pair<double, double>> pins;
    std::map<double, std::vector<std::string>> packs;
    for (int number = 1; number <= max_monitors; ++number) {
        const auto id = fmt::format("{}", number - 1);
        if (const auto own = analog_pins(parameters, number); own && !pins.insert(*own).second)
            kinds[id] = same_pins_monitor;
        if (const auto serial = smart_serial(parameters, number)) packs[*serial].push_back(id);
    }
    for (const auto& [serial, ids] : packs)
        if (packs.size() > 1 && ids.size() == 1) kinds[ids.front()] = smart_pack_monitor;
}

}  // namespace

std::string board_serial(const telemetry::LogFacts& facts) {
    static const std::regex serials("([0-9A-F]{8} [0-9A-F]{8} [0-9A-F]{8})$");
    auto serial = found_in_texts(facts, serials);
    std::ranges::replace(serial, ' ', '-');
    return serial;
}

void add_monitor_kinds(const std::map<std::string, double>& parameters, FlightSeries& series) {
    static const std::map<double, std::string> kinds{
        {9.0, escs_monitor},  {10.0, sum_monitor},  {11.0, fuel_monitor},     {12.0, fuel_monitor},
        {18.0, fuel_monitor}, {24.0, fuel_monitor}, {25.0, throttle_monitor}, {27.0, fuel_monitor}};
    constexpr double voltage_only = 3.0;
    bool is_measured = false;
    bool is_computed = false;
    for (int number = 1; number <= max_monitors; ++number) {
        const auto found = monitor_parameter(parameters, number, "MONITOR");
        if (!found || *found == 0.0 || *found == voltage_only) continue;
        const auto kind = kinds.find(*found);
        if (kind != kinds.end()) series.monitor_kinds[fmt::format("{}", number - 1)] = kind->second;
        is_computed = is_computed || (kind != kinds.end() && kind->second == throttle_monitor);
        is_measured = is_measured || kind == kinds.end() || kind->second == escs_monitor;
    }
    add_known_packs(parameters, series.monitor_kinds);
    if (is_computed && !is_measured) series.current_origin = CurrentOrigin::throttle;
}

std::string pack_serials(const std::map<std::string, double>& parameters) {
    constexpr double dronecan = 8.0;
    std::vector<double> serials;
    for (int number = 1; number <= max_monitors; ++number) {
        const auto serial = smart_serial(parameters, number);
        if (serial && monitor_parameter(parameters, number, "MONITOR") != dronecan) serials.push_back(*serial);
    }
    return joined_serials(serials);
}

const LogFamily& ardupilot_family() {
    static const LogFamily family{ardupilot_tracks(),
                                  {{"BAT", "Instance"},
                                   {"BAT", "Inst"},
                                   {"BAT", nullptr, "H", is_true},
                                   {"ESC", "Instance"},
                                   {"BARO", "I"},
                                   {"GPS", "I", "Status", min_fix},
                                   {"ARSP", "I", "U", is_true},
                                   {"ARSP", "I", "H", is_true},
                                   {"XKF2", "C"},
                                   {"NKF2", "C"}},
                                  describe_ardupilot,
                                  {},
                                  LogFamily::Unstated::noted};
    return family;
}

}  // namespace flightwatt::flight
