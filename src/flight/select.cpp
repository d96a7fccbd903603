#include "flight/select.h"

#include "flight/select/airspeed.h"
#include "flight/select/candidates.h"
#include "flight/select/circuits.h"
#include "flight/select/device_check.h"
#include "flight/select/device_sum.h"
#include "flight/select/outliers.h"
#include "flight/select/positions.h"
#include "flight/select/power.h"
#include "flight/select/supply.h"
#include "flight/select/throttle.h"
#include "flight/select/voltage_dropouts.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

ChosenTrack first_of(const FlightSeries& series, std::string_view name) {
    const auto found =
        std::ranges::find_if(series.tracks, [&](const Track& track) { return track.name == name && !track.empty(); });
    return found == series.tracks.end() ? ChosenTrack{} : cleaned(series, *found);
}

/// The track of batteries without outliers, if it is long enough to know what is far beyond the others.
ChosenTrack cleaned_of_batteries(const FlightSeries& series, const Track& track) {
    constexpr std::size_t enough_samples = 30;
    if (track.time_s.size() < enough_samples) return {within_bounds(track)};
    const bool is_of_power = track.name != "voltage_v" && track.name != "battery_temperature_c";
    return remove_outliers(track, {}, is_of_power ? dropout_throttle(series, track) : Track{});
}

void prepend(std::vector<std::string>& notes, std::vector<std::string> earlier) {
    std::ranges::move(notes, std::back_inserter(earlier));
    notes = std::move(earlier);
}

/// Batteries that the log numbers: to packs, to circuits, to their power.
void choose_batteries(const FlightSeries& series, BatteryTracks found, FlightData& data) {
    auto power = cleaned_of_batteries(series, found.power_w);
    prepend(power.notes, std::move(found.power_w.notes));
    power.not_chosen = std::move(found.power_w.not_chosen);
    const bool is_zero = std::ranges::all_of(power.value, [](double watts) { return watts == 0.0; });
    if (is_zero || power.time_s.size() < 2) {
        power.not_chosen.emplace_back("the batteries' power is 0 throughout");
        static_cast<Track&>(power) = {};
    }
    data.power_w = std::move(power);
    if (!found.note.empty()) data.notes.push_back(std::move(found.note));
    data.energy_wh = cleaned_of_batteries(series, found.energy_wh);
    for (auto& circuit : found.circuits) {
        circuit.power_w = cleaned_of_batteries(series, circuit.power_w);
        circuit.voltage_v = cleaned_of_batteries(series, circuit.voltage_v);
        circuit.current_a = cleaned_of_batteries(series, circuit.current_a);
        circuit.charge_ah = cleaned_of_batteries(series, circuit.charge_ah);
        circuit.battery_temperature_c = cleaned_of_batteries(series, circuit.battery_temperature_c);
    }
    data.circuits = std::move(found.circuits);
    data.voltage_v = {data.circuits.front().voltage_v};
    data.current_a = {data.circuits.front().current_a};
    data.charge_ah = {data.circuits.front().charge_ah};
    data.battery_temperature_c = {data.circuits.front().battery_temperature_c};
    data.stated_capacity_ah = data.circuits.front().stated_capacity_ah;
    data.stated_cells = data.circuits.front().stated_cells;
    data.monitors = data.circuits.front().monitors;
}

/// The pack's current, else the sum of the consumers' currents; no voltage of consumers with different ones.
void choose_voltage_and_current(const FlightSeries& series, FlightData& data) {
    data.voltage_v = first_that_varies(series, "voltage_v");
    data.current_a = first_that_varies(series, "current_a");
    const auto reason = differing_voltages_reason(series);
    if (!reason.empty() && data.voltage_v.source.starts_with("POWER_DEVICE")) data.voltage_v = {{}, {reason}};
    for (const auto* message : device_messages) {
        if (!data.current_a.empty()) break;
        if (const auto escs = devices_of(series, "voltage_v", message); data.voltage_v.empty() && !escs.empty())
            data.voltage_v = {escs.front().track};
        if (message == std::string_view("POWER_DEVICE") && !reason.empty()) continue;
        data.current_a = {sum_over_devices(devices_of(series, "current_a", message)).track};
    }
    data.charge_ah = first_that_varies(series, "charge_ah");
    data.energy_wh = first_that_varies(series, "energy_wh");
    data.battery_temperature_c = first_that_varies(series, "battery_temperature_c");
    if (series.monitor_capacities_ah.size() == 1)
        data.stated_capacity_ah = series.monitor_capacities_ah.begin()->second;
    if (series.monitor_cells.size() == 1) data.stated_cells = stated_cells(series, series.monitor_cells.begin()->first);
}

/// Puts the ESCs in the place of batteries without a power, whose voltage stays, or of those that do not supply them.
void use_escs(const FlightSeries& series, std::string reason, bool is_their_pack, FlightData& data) {
    auto not_chosen = std::move(data.power_w.not_chosen);
    if (!reason.empty()) not_chosen.push_back(std::move(reason));
    data.power_w = select_esc_power(series);
    prepend(data.power_w.not_chosen, std::move(not_chosen));
    if (data.power_w.empty() && is_their_pack) return;
    data.current_a = {sum_over_devices(devices_of(series, "current_a", "ESC")).track};
    data.charge_ah = data.energy_wh = {};
    data.circuits.clear();
    data.notes = series.notes;
    if (is_their_pack) return;
    const auto escs = devices_of(series, "voltage_v", "ESC");
    data.voltage_v = escs.empty() ? ChosenTrack{} : ChosenTrack{escs.front().track};
    data.battery_temperature_c = {};
    data.stated_capacity_ah.reset();
}

/// Batteries give what the ESCs of a multirotor draw, and that of the electronics, which rises little with it.
void check_excess(const FlightSeries& series, const std::vector<Device>& escs, FlightData& data) {
    const bool are_all = series.motors && static_cast<double>(escs.size()) >= *series.motors;
    if (!are_all || series.firmware != "rotorcraft") return;  // another one's pusher may have no telemetry
    const auto count = escs.size();
    if (const auto ratio = rise_beyond_escs(data.power_w, sum_over_devices(escs).track))
        data.power_w.notes.push_back(fmt::format(
            "under load {} gives {:.2f} times the power of all {} ESCs: check the scales of both; the power "
            "is that of the former, perhaps too large",
            data.circuits.size() == 1 ? data.circuits.front().name : data.power_w.source, *ratio, count));
}

/// ESCs draw what the batteries give: a source that gives less is no measurement of their supply.
void check_supply(const FlightSeries& series, FlightData& data) {
    if (data.power_w.empty() && !data.circuits.empty()) return use_escs(series, "", true, data);
    if (data.power_w.source.starts_with("ESC")) return;
    const auto escs = devices_of(series, "power_w", "ESC");
    const auto shortfall = compare_with_escs(data.power_w, sum_over_devices(escs).track);
    if (!shortfall) return check_excess(series, escs, data);
    const auto supply = data.circuits.size() == 1 ? data.circuits.front().name : data.power_w.source;
    const auto finding = fmt::format("the ESCs draw {:.0f} W on average, but {} gives {:.0f} W", shortfall->escs_w,
                                     supply, shortfall->supply_w);
    if (shortfall->is_other_supply)
        return use_escs(series, finding + " and does not rise with them: it is not their supply", false, data);
    data.power_w.notes.push_back(finding +
                                 ": check the scales of both; the power is that of the latter, perhaps too small");
}

/// A column of power in a user's CSV goes before its batteries.
void choose_electrical(const FlightSeries& series, FlightData& data) {
    const bool is_plain = has_plain_power(series);
    if (auto batteries = is_plain ? std::nullopt : select_batteries(series)) {
        choose_batteries(series, *std::move(batteries), data);
    } else {
        data.power_w = select_power(series);
        choose_voltage_and_current(series, data);
    }
    if (!is_plain) check_supply(series, data);
}

/// Those other than the chosen one, which may confirm or contradict it.
std::vector<Track> other_altitudes(const FlightSeries& series, const Track& chosen) {
    std::vector<Track> others;
    for (const auto& track : series.tracks)
        if (track.name == "altitude_m" && track.source != chosen.source) others.push_back(track);
    return others;
}

constexpr ChosenTrack FlightData::*with_own_rule[] = {&FlightData::power_w,
                                                      &FlightData::voltage_v,
                                                      &FlightData::current_a,
                                                      &FlightData::charge_ah,
                                                      &FlightData::energy_wh,
                                                      &FlightData::throttle_percent,
                                                      &FlightData::ground_speed_m_per_s,
                                                      &FlightData::battery_temperature_c};

}  // namespace

FlightData select_tracks(const FlightSeries& logged) {
    auto without = without_voltage_dropouts(logged);
    const auto& series = without.series ? *without.series : logged;
    FlightData data;
    // Clock, identity and kind of vehicle are the log's.
    static_cast<FlightInfo&>(data) = series;
    data.last_s = last_time_s(series);
    // Monitors to packs, packs to circuits; power, voltage, current and counters.
    choose_electrical(series, data);
    prepend(data.power_w.notes, std::move(without.warnings));
    data.throttle_percent = select_throttle(series, data.power_w);
    // Altitude, position, speed, wind and states.
    for (const auto& [name, member] : track_members())
        if (std::ranges::find(with_own_rule, member) == std::end(with_own_rule))
            data.*member = first_that_varies(series, name);
    remove_unreachable_positions(data);
    data.other_altitudes = other_altitudes(series, data.altitude_m);
    data.ground_speed_m_per_s = first_of(series, "ground_speed_m_per_s");
    if (is_constant(data.airspeed_m_per_s))  // there is no sensor
        data.airspeed_m_per_s = {{}, std::move(data.airspeed_m_per_s.notes)};
    estimate_airspeed(data);
    return data;
}

std::optional<double> stated_ground_altitude_m(const FlightData& data) {
    // Altitudes above the reference on the ground: of Paparazzi's rotorcraft, and MAVLink's relative_alt.
    const auto& source = data.altitude_m.source;
    if (source.starts_with("ROTORCRAFT_FP") || source.starts_with("GLOBAL_POSITION_INT")) return 0.0;
    const auto logged = last_value(data.ground_altitude_m);
    return logged ? logged : data.planned_ground_altitude_m;
}

bool is_above_sea(const Track& altitude) {
    static const std::set<std::string_view> sources{
        // Paparazzi; the Matrice 100's CSV
        "ESTIMATOR.z", "GPS.alt", "GPS_INT.hmsl", "AIR_DATA.amsl_baro", "position_z",
        // ArduPilot and PX4's early logs; PX4; MAVLink
        "POS.Alt", "GPS.Alt", "GPOS.Alt", "vehicle_global_position.alt", "vehicle_gps_position.altitude_msl_m",
        "vehicle_gps_position.alt", "GPS_RAW_INT.alt",
        // The user's own
        plain_source};
    auto source = altitude.source;
    if (const auto instance = source.find('['); instance != std::string::npos)
        source.erase(instance, source.find(']') - instance + 1);
    return sources.contains(source);
}

}  // namespace flightwatt::flight
