#include "flight/families/mavlink_family.h"

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/families/ardupilot_family.h"
#include "flight/families/derived_tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

/// Where MAVLink has the quantities of a flight (docs/formats.md).
namespace flightwatt::flight {
namespace {

constexpr double unknown_16_bit = 65535.0;
constexpr double unknown = -1.0;
constexpr double no_temperature = 32767.0;
constexpr std::size_t cells = 10;
constexpr std::size_t further_cells = 4;

/// The voltages of the cells; an autopilot that knows none of them puts the pack's into the first ones.
std::vector<FamilySource> cell_voltages() {
    std::vector<FamilySource> sources;
    static const auto names = [] {
        std::vector<std::string> all;
        for (std::size_t i = 0; i < cells; ++i) all.push_back(fmt::format("voltages[{}]", i));
        for (std::size_t i = 0; i < further_cells; ++i) all.push_back(fmt::format("voltages_ext[{}]", i));
        return all;
    }();
    for (std::size_t i = 0; i < names.size(); ++i)
        sources.push_back({names[i].c_str(), "mV", nullptr, i < cells ? unknown_16_bit : 0.0});
    return sources;
}

double sum_of_cells(const std::vector<double>& cells_v) {
    double sum_v = 0.0;
    for (std::size_t i = 0; i < cells + further_cells; ++i)
        if (cells_v[i] < unknown_16_bit * units::milli)
            sum_v += cells_v[i];  // some state so that there is no further one
    return sum_v > 0.0 ? sum_v : no_value;
}

double power_of_cells(const std::vector<double>& cells_and_current) {
    return sum_of_cells(cells_and_current) * cells_and_current.back();
}

/// WIND states where the wind comes from.
double wind_east(const std::vector<double>& direction_and_speed) {
    return -direction_and_speed[1] * std::sin(direction_and_speed[0] / units::degree_per_rad);
}
double wind_north(const std::vector<double>& direction_and_speed) {
    return -direction_and_speed[1] * std::cos(direction_and_speed[0] / units::degree_per_rad);
}

double is_armed_mode(const std::vector<double>& base_mode) {
    constexpr unsigned armed_flag = 128;
    return (static_cast<unsigned>(base_mode[0]) & armed_flag) != 0 ? 1.0 : 0.0;
}

/// 0 is undefined, 1 on ground, 2 to 4 in the air, taking off and landing.
double is_landed(const std::vector<double>& state) { return state[0] == 0.0 ? no_value : state[0] == 1.0 ? 1.0 : 0.0; }

/// Without a week GPS counts from 1980 on.
double if_known_time(const std::vector<double>& utc_s) {
    constexpr double second_gps_week_s = 316'569'600.0;
    return utc_s[0] > second_gps_week_s ? utc_s[0] : no_value;
}

std::vector<FamilyTrack> mavlink_tracks() {
    constexpr auto mean = Merge::mean;
    constexpr auto latest = Merge::latest;
    const FamilySource pack_current{"current_battery", "cA", nullptr, unknown};
    const FamilySource pack_voltage{"voltage_battery", "mV", nullptr, unknown_16_bit};
    const FamilySource second_voltage{"voltage", "mV", nullptr, unknown_16_bit};
    auto cells_and_current = cell_voltages();
    cells_and_current.push_back(pack_current);
    const std::vector<FamilySource> wind{{"direction"}, {"speed"}};
    return {
        {"power_w", "BATTERY_STATUS", cells_and_current, mean, power_of_cells, nullptr,
         "BATTERY_STATUS.voltages * BATTERY_STATUS.current_battery"},
        {"voltage_v", "BATTERY_STATUS", cell_voltages(), mean, sum_of_cells, nullptr, "BATTERY_STATUS.voltages"},
        {"current_a", "BATTERY_STATUS", {pack_current}},
        {"charge_ah", "BATTERY_STATUS", {{"current_consumed", "mAh", nullptr, unknown}}, latest},
        {"energy_wh", "BATTERY_STATUS", {{"energy_consumed", "100J", nullptr, unknown}}, latest},
        {"battery_temperature_c",
         "BATTERY_STATUS",
         {{"temperature", "0.01degC", nullptr, no_temperature}},
         mean,
         if_stated_temperature},
        {"power_w", "SYS_STATUS", {pack_voltage, pack_current}, mean, product},
        {"voltage_v", "SYS_STATUS", {pack_voltage}},
        {"current_a", "SYS_STATUS", {pack_current}},
        {"power_w", "BATTERY2", {second_voltage, pack_current}, mean, product, nullptr, nullptr, "1"},
        {"voltage_v", "BATTERY2", {second_voltage}, mean, nullptr, nullptr, nullptr, "1"},
        {"current_a", "BATTERY2", {pack_current}, mean, nullptr, nullptr, nullptr, "1"},
        {"altitude_m", "GLOBAL_POSITION_INT", {{"relative_alt", "mm"}}},
        {"altitude_m", "VFR_HUD", {{"alt", "m"}}},
        {"altitude_m", "GPS_RAW_INT", {{"alt", "mm"}}},
        {"ground_speed_m_per_s", "GLOBAL_POSITION_INT", {{"vx", "cm/s"}, {"vy", "cm/s"}}, mean, speed_of},
        {"ground_speed_m_per_s", "VFR_HUD", {{"groundspeed", "m/s"}}},
        {"airspeed_m_per_s", "VFR_HUD", {{"airspeed", "m/s"}}},
        {"wind_east_m_per_s", "WIND", wind, mean, wind_east},
        {"wind_east_m_per_s", "WIND_COV", {{"wind_y", "m/s"}}},
        {"wind_north_m_per_s", "WIND", wind, mean, wind_north},
        {"wind_north_m_per_s", "WIND_COV", {{"wind_x", "m/s"}}},
        {"latitude_deg", "GPS_RAW_INT", {{"lat", "1e7deg"}}, latest},
        {"latitude_deg", "GLOBAL_POSITION_INT", {{"lat", "1e7deg"}}, latest},
        {"longitude_deg", "GPS_RAW_INT", {{"lon", "1e7deg"}}, latest},
        {"longitude_deg", "GLOBAL_POSITION_INT", {{"lon", "1e7deg"}}, latest},
        {"heading_deg", "GLOBAL_POSITION_INT", {{"hdg", "0.01deg", nullptr, unknown_16_bit}}, latest},
        {"course_deg", "GPS_RAW_INT", {{"cog", "0.01deg", nullptr, unknown_16_bit}}, latest},
        {"climb_m_per_s", "VFR_HUD", {{"climb", "m/s"}}},
        {"climb_m_per_s", "GLOBAL_POSITION_INT", {{"vz", "-1cm/s"}}},
        {"roll_deg", "ATTITUDE", {{"roll", "rad"}}, latest},
        {"throttle_percent", "VFR_HUD", {{"throttle", "%"}}},
        {"mode", "HEARTBEAT", {{"custom_mode"}}, latest},
        {"armed", "HEARTBEAT", {{"base_mode"}}, latest, is_armed_mode},
        {"vtol_state", "EXTENDED_SYS_STATE", {{"vtol_state"}}, latest, if_vtol_state},
        {"landed", "EXTENDED_SYS_STATE", {{"landed_state"}}, latest, is_landed},
        {"fix", "GPS_RAW_INT", {{"fix_type"}}, latest},
        {utc_track, "SYSTEM_TIME", {{"time_unix_usec", "1e-6s"}}, latest, if_known_time},
    };
}

/// The first value of a field of the heartbeat; NaN without one.
double of_heartbeat(const telemetry::AutopilotLog& log, const char* field) {
    const auto* heartbeat = log.log.senders.front().table("HEARTBEAT");
    const auto* column = heartbeat == nullptr ? nullptr : heartbeat->column(field);
    return column == nullptr || column->values.empty() ? no_value : column->values.front();
}

/// Whether heartbeats state hardware in the loop: an autopilot that flies in a simulator.
bool has_simulated_sensors(const telemetry::AutopilotLog& log) {
    constexpr unsigned hardware_in_the_loop = 32;
    const auto* heartbeat = log.log.senders.front().table("HEARTBEAT");
    const auto* modes = heartbeat == nullptr ? nullptr : heartbeat->column("base_mode");
    return modes != nullptr && std::ranges::any_of(modes->values, [](double mode) {
               return mode >= 0.0 && (static_cast<unsigned>(mode) & hardware_in_the_loop) != 0;
           });
}

/// ArduPilot's name of its vehicle, by MAVLink's number of the type.
std::string ardupilot_name(double type) {
    constexpr double first_vtol = 19.0;
    constexpr double last_vtol = 25.0;
    constexpr double submarine = 12.0;
    const auto firmware = firmware_of_type(type);
    if (firmware == "rotorcraft") return "ArduCopter";
    if (firmware == "fixedwing" || (type >= first_vtol && type <= last_vtol)) return "ArduPlane";
    if (firmware == "rover") return "ArduRover";
    return type == submarine ? "ArduSub" : "ArduPilot";
}

void describe_mavlink(const telemetry::AutopilotLog& log, FlightSeries& series) {
    constexpr double ardupilot = 3.0;
    constexpr double px4 = 12.0;
    const auto& facts = log.facts;
    const double autopilot = of_heartbeat(log, "autopilot");
    const double type = of_heartbeat(log, "type");
    series.aircraft_id = board_serial(facts);
    if (const auto uid = facts.information.find("uid"); series.aircraft_id.empty() && uid != facts.information.end())
        series.aircraft_id = uid->second;
    if (series.aircraft_id.empty()) series.aircraft_id = log.log.senders.front().id;
    series.aircraft_name = autopilot == ardupilot ? ardupilot_name(type) : autopilot == px4 ? "PX4" : "MAVLink";
    const auto is_simulation = [](const auto& of) { return of.name == "SIMSTATE"; };
    if (std::ranges::any_of(log.messages, is_simulation))
        series.aircraft_name += " SITL";
    else if (has_simulated_sensors(log))
        series.aircraft_name += " HITL";
    series.firmware = firmware_of_type(type);
    if (const auto start = facts.information.find("start_unix_s"); start != facts.information.end())
        series.start_clock_s = parse_number(start->second);
    series.monitor_capacities_ah = monitor_capacities_ah(facts.parameters, {"BATT_CAPACITY"}, "BATTN_CAPACITY");
    series.monitor_capacities_ah.merge(
        monitor_capacities_ah(facts.parameters, {"BAT1_CAPACITY", "BAT_CAPACITY"}, "BATN_CAPACITY"));
    add_monitor_kinds(facts.parameters, series);
    series.pack_serial = pack_serials(facts.parameters);
    series.notes.insert(series.notes.end(), facts.notes.begin(), facts.notes.end());
}

bool has_values(const telemetry::MessageTable& table, const char* field, double absent) {
    const auto* column = table.column(field);
    return column != nullptr && std::ranges::any_of(column->values, [&](double value) {
               return std::isfinite(value) && value != absent && value != 0.0;
           });
}

/// Whether the status has an airspeed sensor (differential pressure) that is enabled and in health.
bool has_airspeed_sensor(const telemetry::MessageTable& status) {
    constexpr std::uint32_t differential_pressure = 1U << 4U;
    const auto* enabled = status.column("onboard_control_sensors_enabled");
    const auto* health = status.column("onboard_control_sensors_health");
    for (std::size_t i = 0; enabled != nullptr && health != nullptr && i < enabled->values.size(); ++i) {
        const auto both =
            static_cast<std::uint32_t>(enabled->values[i]) & static_cast<std::uint32_t>(health->values[i]);
        if ((both & differential_pressure) != 0) return true;
    }
    return false;
}

/// The sum of each row's cells if it has the ten that the message held before its extension; else NaN.
std::vector<double> sums_of_ten_cells(const telemetry::MessageTable& battery) {
    std::vector<double> sums(battery.time_s.size(), 0.0);
    for (const auto& cell : cell_voltages()) {
        const auto* column = battery.column(cell.field);
        const bool is_expected = cell.absent == unknown_16_bit;
        for (std::size_t row = 0; row < sums.size(); ++row) {
            const double value = column == nullptr ? no_value : column->values[row];
            const bool is_known = value > 0.0 && value != unknown_16_bit;
            sums[row] += is_known != is_expected ? no_value : is_known ? value : 0.0;
        }
    }
    return sums;
}

/// Completes the voltage of packs with more than ten cells of PX4, whose older versions leave out the others: each has
/// the mean of the pack, and the status has the whole voltage.
void complete_cells(telemetry::MessageTable& battery, const telemetry::MessageTable& status,
                    std::vector<std::string>& notes) {
    constexpr double stated_cells = cells;
    const auto* voltage = status.column("voltage_battery");
    if (voltage == nullptr) return;
    auto packs_mv = voltage->values;
    std::erase_if(packs_mv, [](double value) { return !(value > 0.0) || value == unknown_16_bit; });
    const auto sums_mv = sums_of_ten_cells(battery);
    auto known_mv = sums_mv;
    std::erase_if(known_mv, [](double value) { return std::isnan(value); });
    if (packs_mv.empty() || known_mv.empty()) return;
    const double all_cells = std::round(stated_cells * median(std::move(packs_mv)) / median(std::move(known_mv)));
    if (all_cells <= stated_cells) return;
    for (auto& column : battery.columns)
        for (std::size_t row = 0; column.field.starts_with("voltages[") && row < sums_mv.size(); ++row)
            if (!std::isnan(sums_mv[row])) column.values[row] *= all_cells / stated_cells;
    notes.push_back(fmt::format(
        "BATTERY_STATUS has {} of {:.0f} cells by the voltage of SYS_STATUS: the others are added", cells, all_cells));
}

/// Keeps the rows of a message that count.
template <typename Counts>
void keep_rows(telemetry::MessageTable& table, const Counts& counts) {
    telemetry::MessageTable kept{table.message, {}, table.columns, {}};
    for (auto& column : kept.columns) column.values.clear();
    for (std::size_t row = 0; row < table.time_s.size(); ++row) {
        if (!counts(row)) continue;
        kept.time_s.push_back(table.time_s[row]);
        if (row < table.places.size()) kept.places.push_back(table.places[row]);
        for (std::size_t k = 0; k < kept.columns.size(); ++k)
            kept.columns[k].values.push_back(table.columns[k].values[row]);
    }
    table = std::move(kept);
}

/// Leaves out batteries that supply no motors, by their battery_function.
void leave_out_other_batteries(telemetry::MessageTable& battery, std::vector<std::string>& notes) {
    constexpr double avionics = 3.0;
    constexpr double payload = 4.0;
    const auto* id = battery.column("id");
    const auto* function = battery.column("battery_function");
    if (id == nullptr || function == nullptr) return;
    std::map<double, std::string> others;
    for (std::size_t row = 0; row < function->values.size(); ++row) {
        const double value = function->values[row];
        if (value == avionics || value == payload)
            others[id->values[row]] = value == payload ? "a payload" : "the avionics";
    }
    for (const auto& [number, use] : others)
        notes.push_back(
            fmt::format("battery {:.0f} is not counted: it is that of {}, as BATTERY_STATUS states", number, use));
    const auto is_counted = [&](std::size_t row) {
        return function->values[row] != avionics && function->values[row] != payload;
    };
    if (!others.empty()) keep_rows(battery, is_counted);
}

/// Whether the log has one battery, whose voltage and current the status states too.
bool has_its_power(const telemetry::MessageTable& status, const telemetry::MessageTable& battery) {
    if (battery.empty()) return false;
    const auto* id = battery.column("id");
    const bool is_one = id == nullptr || std::ranges::count(id->values, id->values.front()) ==
                                             static_cast<std::ptrdiff_t>(id->values.size());
    return is_one && has_values(status, "voltage_battery", unknown_16_bit) &&
           has_values(status, "current_battery", unknown);
}

constexpr double missed_s = 10.0;  // of a message, while another one comes

/// Whether the status continues where the battery's own message has ended.
bool outlasts(const telemetry::MessageTable& status, const telemetry::MessageTable& battery) {
    return status.time_s.back() > battery.time_s.back() + missed_s;
}

/// Whether the heartbeats state an armed vehicle (or a disarmed one) in an interval.
bool states_armed(const telemetry::MessageTable* heartbeat, bool armed, double from_s, double to_s) {
    const auto* mode = heartbeat == nullptr ? nullptr : heartbeat->column("base_mode");
    for (std::size_t i = 0; mode != nullptr && i < mode->values.size(); ++i) {
        const double time_s = heartbeat->time_s[i];
        if (time_s >= from_s && time_s <= to_s && (is_armed_mode({mode->values[i]}) != 0.0) == armed) return true;
    }
    return false;
}

/// Whether a message begins only while the vehicle is armed, as the station asked for it then, so long after another.
bool begins_in_flight(const telemetry::MessageTable& message, const telemetry::MessageTable& other,
                      const telemetry::MessageTable* heartbeat, double later_s) {
    return states_armed(heartbeat, true, other.time_s.front(), message.time_s.front() - later_s);
}

/// Leaves out height and speed by the estimated position where this begins or ends in flight, as without a fix, if the
/// head-up display has them from the ground on.
void leave_out_partial_position(telemetry::MessageTable& position, const telemetry::MessageTable& hud,
                                const telemetry::MessageTable* heartbeat, std::vector<std::string>& notes) {
    if (position.empty() || hud.empty()) return;
    const double begin_s = hud.time_s.front();
    const bool begins = begins_in_flight(position, hud, heartbeat, missed_s) &&
                        states_armed(heartbeat, false, begin_s, position.time_s.front() - missed_s);
    const bool ends = states_armed(heartbeat, true, position.time_s.back() + missed_s, hud.time_s.back()) &&
                      states_armed(heartbeat, false, begin_s, position.time_s.back());
    if (!begins && !ends) return;
    const auto has = [&](const char* field) { return has_values(hud, field, no_value); };
    const bool replaces_height = has("alt");
    const bool replaces_speed = has("groundspeed");
    std::erase_if(position.columns, [&](const telemetry::Column& column) {
        const bool is_speed = column.field == "vx" || column.field == "vy";
        return (replaces_height && column.field == "relative_alt") || (replaces_speed && is_speed);
    });
    if (replaces_height)
        notes.push_back(fmt::format("GLOBAL_POSITION_INT {} in flight: the altitude is that of VFR_HUD",
                                    begins ? "begins" : "ends"));
}

/// Leaves out the speeds of a message that are 0 throughout, as of an aircraft at rest: it knows none, as without GPS, or
/// has them in the other message alone (older Betaflight).
void leave_out_unknown_speeds(telemetry::MessageTable& table) {
    constexpr std::array speeds{"vx", "vy", "groundspeed"};
    for (const auto* speed : speeds)
        if (has_values(table, speed, no_value)) return;
    std::erase_if(table.columns,
                  [&](const auto& column) { return std::ranges::find(speeds, column.field) != speeds.end(); });
}

/// Leaves out an energy that is more than its charge has at any voltage, as INAV counts it.
void leave_out_impossible_energy(telemetry::MessageTable& battery, std::vector<std::string>& notes) {
    constexpr double max_voltage_v = 1000.0;
    constexpr double joule_per_unit = 100.0;
    const auto* energy = battery.column("energy_consumed");
    const auto* charge_mah = battery.column("current_consumed");
    if (energy == nullptr || charge_mah == nullptr) return;
    for (std::size_t row = battery.time_s.size(); row-- > 0;) {
        const double charge_ah = charge_mah->values[row] * units::milli;
        const double voltage_v = units::wh_from_joule(joule_per_unit * energy->values[row]) / charge_ah;
        if (!(charge_ah > 0.0 && voltage_v > 0.0)) continue;
        if (voltage_v < max_voltage_v) return;
        notes.push_back(
            fmt::format("the energy counted by BATTERY_STATUS is not used: with its charge it would be of "
                        "{:.0f} V (INAV sends 1000 times the energy)",
                        voltage_v));
        std::erase_if(battery.columns, [](const auto& column) { return column.field == "energy_consumed"; });
        return;
    }
}

/// States the hover of ArduPilot's VTOLs by their modes where no message of its own does.
void add_hover_of_modes(telemetry::AutopilotLog& log) {
    static const std::set<double> hovers{17.0, 18.0, 19.0, 20.0, 22.0, 23.0};  // not QRTL, which begins on the wing
    constexpr double ardupilot = 3.0;
    constexpr double hover = 3.0;
    constexpr double wing = 4.0;
    auto& sender = log.log.senders.front();
    const auto* heartbeat = sender.table("HEARTBEAT");
    const auto* mode = heartbeat == nullptr ? nullptr : heartbeat->column("custom_mode");
    const auto* base_mode = heartbeat == nullptr ? nullptr : heartbeat->column("base_mode");
    if (mode == nullptr || base_mode == nullptr || sender.table("EXTENDED_SYS_STATE") != nullptr) return;
    if (of_heartbeat(log, "autopilot") != ardupilot || ardupilot_name(of_heartbeat(log, "type")) != "ArduPlane") return;
    telemetry::Column state{"vtol_state", std::nullopt, {}};
    bool has_hover = false;
    for (std::size_t row = 0; row < mode->values.size(); ++row) {
        const bool is_hover = hovers.contains(mode->values[row]);
        has_hover = has_hover || (is_hover && is_armed_mode({base_mode->values[row]}) != 0.0);
        state.values.push_back(is_hover ? hover : wing);
    }
    if (!has_hover) return;
    log.facts.notes.emplace_back(
        "EXTENDED_SYS_STATE is not in the recording: the hover is by the modes QSTABILIZE to QACRO; in AUTO it counts as "
        "on the wing");
    sender.tables.push_back({"EXTENDED_SYS_STATE", heartbeat->time_s, {std::move(state)}, heartbeat->places});
}

/// A time in which the battery's own message is silent, and the status is not.
struct Silence {
    double from_s;
    double duration_s;
};

/// The first silence: from the first status on, if the battery's message begins in flight, also perhaps, as no heartbeat
/// is that of an armed vehicle; or between two of its messages; std::nullopt without one.
std::optional<Silence> find_silence(const telemetry::MessageTable& status, const telemetry::MessageTable& battery,
                                    const telemetry::MessageTable* heartbeat) {
    constexpr double pause_s = 30.0;  // for less the counters of the battery are kept
    constexpr double dense_s = 5.0;
    constexpr double ever_s = std::numeric_limits<double>::infinity();
    const Silence at_first{status.time_s.front(), battery.time_s.front() - status.time_s.front()};
    const bool shows_flight = states_armed(heartbeat, true, -ever_s, ever_s);
    if (shows_flight ? begins_in_flight(battery, status, heartbeat, pause_s) : at_first.duration_s > pause_s)
        return at_first;
    for (std::size_t i = 1; i < battery.time_s.size(); ++i) {
        const Silence silence{battery.time_s[i - 1], battery.time_s[i] - battery.time_s[i - 1]};
        if (silence.duration_s <= pause_s) continue;
        const auto rows = std::ranges::count_if(status.time_s, [&](double time_s) {
            return time_s > silence.from_s && time_s < silence.from_s + silence.duration_s;
        });
        if (dense_s * static_cast<double>(rows) >= silence.duration_s) return silence;
    }
    return std::nullopt;
}

/// Whether the battery's own message is too rare for the power of a phase, and the status is not.
bool is_denser(const telemetry::MessageTable& status, const telemetry::MessageTable& battery) {
    constexpr double rare_s = 5.0;
    constexpr std::size_t denser = 4;
    const auto rows = battery.time_s.size();
    return status.time_s.back() - status.time_s.front() > rare_s * static_cast<double>(rows) &&
           status.time_s.size() > denser * rows;
}

/// Leaves the counters and the temperature of the only battery, whose voltage and current the status has.
void leave_counters(telemetry::MessageTable& battery) {
    std::erase_if(battery.columns, [](const telemetry::Column& column) {
        return column.field != "temperature" && !column.field.ends_with("_consumed");
    });
}

/// Leaves the only battery's temperature; its counters are as rare as its power.
void leave_temperature(telemetry::MessageTable& battery) {
    std::erase_if(battery.columns, [](const telemetry::Column& column) { return column.field != "temperature"; });
}

}  // namespace

const LogFamily& mavlink_family() {
    static const LogFamily family{
        mavlink_tracks(),
        {{"BATTERY_STATUS", "id"}, {"GPS_RAW_INT", nullptr, "fix_type", min_fix}},
        describe_mavlink,
        {{"SYS_STATUS", {"onboard_control_sensors_enabled", "onboard_control_sensors_health"}},
         {"BATTERY_STATUS", {"battery_function"}},
         {"HEARTBEAT", {"type", "autopilot"}}}};
    return family;
}

telemetry::AutopilotLog without_doubtful_messages(telemetry::AutopilotLog log) {
    auto& tables = log.log.senders.front().tables;
    const auto find = [&](const char* name) {
        return std::ranges::find(tables, name, &telemetry::MessageTable::message);
    };
    const auto battery = find("BATTERY_STATUS");
    const auto status = find("SYS_STATUS");
    const auto hud = find("VFR_HUD");
    if (hud != tables.end() && (status == tables.end() || !has_airspeed_sensor(*status)))
        std::erase_if(hud->columns, [](const telemetry::Column& column) { return column.field == "airspeed"; });
    const auto beat = find("HEARTBEAT");
    const auto* heartbeat = beat == tables.end() ? nullptr : &*beat;
    const auto position = find("GLOBAL_POSITION_INT");
    if (position != tables.end() && hud != tables.end())
        leave_out_partial_position(*position, *hud, heartbeat, log.facts.notes);
    if (position != tables.end()) leave_out_unknown_speeds(*position);
    if (hud != tables.end()) leave_out_unknown_speeds(*hud);
    if (battery != tables.end()) {
        leave_out_other_batteries(*battery, log.facts.notes);
        leave_out_impossible_energy(*battery, log.facts.notes);
    }
    const bool has_battery = battery != tables.end() && has_values(*battery, "voltages[0]", unknown_16_bit) &&
                             has_values(*battery, "current_battery", unknown);
    if (has_battery && status != tables.end()) complete_cells(*battery, *status, log.facts.notes);
    const auto* id = battery == tables.end() ? nullptr : battery->column("id");
    const bool has_second = id != nullptr && std::ranges::find(id->values, 1.0) != id->values.end();
    if (battery != tables.end() && !has_battery && status != tables.end() && has_its_power(*status, *battery))
        leave_counters(*battery);
    const bool is_replaced = has_battery && status != tables.end() && has_its_power(*status, *battery);
    const bool is_rare = is_replaced && is_denser(*status, *battery);
    const bool has_ended = is_replaced && !is_rare && outlasts(*status, *battery);
    const auto silence =
        is_replaced && !is_rare && !has_ended ? find_silence(*status, *battery, heartbeat) : std::nullopt;
    if (has_ended)
        log.facts.notes.push_back(fmt::format("BATTERY_STATUS ends {:.0f} s before SYS_STATUS, which is used",
                                              status->time_s.back() - battery->time_s.back()));
    if (is_rare) {
        log.facts.notes.push_back(fmt::format("BATTERY_STATUS came {} time{} in {:.0f} s: the power is by SYS_STATUS",
                                              battery->time_s.size(), battery->time_s.size() == 1 ? "" : "s",
                                              status->time_s.back() - status->time_s.front()));
    }
    if (silence)
        log.facts.notes.push_back(
            fmt::format("BATTERY_STATUS is silent for {:.0f} s from {:.0f} s on: the power is by SYS_STATUS",
                        silence->duration_s, silence->from_s));
    if (is_rare || silence) leave_temperature(*battery);
    std::erase_if(tables, [&](const telemetry::MessageTable& table) {
        const bool is_unused =
            has_battery && !is_rare && !silence && table.message == (has_ended ? "BATTERY_STATUS" : "SYS_STATUS");
        return table.empty() || is_unused || (has_second && table.message == "BATTERY2");
    });
    add_hover_of_modes(log);
    return log;
}

}  // namespace flightwatt::flight
