#include "flight/flight_data.h"

#include "base/error.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {

std::span<const TrackMember> track_members() {
    using D = FlightData;
    static constexpr auto members = std::to_array<TrackMember>({
        {"altitude_m", &D::altitude_m},
        {"throttle_percent", &D::throttle_percent},
        {"voltage_v", &D::voltage_v},
        {"current_a", &D::current_a},
        {"power_w", &D::power_w},
        {"charge_ah", &D::charge_ah},
        {"energy_wh", &D::energy_wh},
        {"east_m", &D::east_m},
        {"north_m", &D::north_m},
        {"ground_speed_m_per_s", &D::ground_speed_m_per_s},
        {"airspeed_m_per_s", &D::airspeed_m_per_s},
        {"wind_speed_m_per_s", &D::wind_speed_m_per_s},
        {"wind_east_m_per_s", &D::wind_east_m_per_s},
        {"wind_north_m_per_s", &D::wind_north_m_per_s},
        {"latitude_deg", &D::latitude_deg},
        {"longitude_deg", &D::longitude_deg},
        {"heading_deg", &D::heading_deg},
        {"course_deg", &D::course_deg},
        {"climb_m_per_s", &D::climb_m_per_s},
        {"roll_deg", &D::roll_deg},
        {"air_temperature_c", &D::air_temperature_c},
        {"battery_temperature_c", &D::battery_temperature_c},
        {"motor_speed_rpm", &D::motor_speed_rpm},
        {"mass_kg", &D::mass_kg},
        {"rotor_area_m2", &D::rotor_area_m2},
        {"mode", &D::mode},
        {"block", &D::block},
        {"rover_mode", &D::rover_mode},
        {"takeoff", &D::takeoff},
        {"armed", &D::armed},
        {"landed", &D::landed},
        {"fix", &D::fix},
        {"vtol_state", &D::vtol_state},
        {"ground_altitude_m", &D::ground_altitude_m},
        {"payload_kg", &D::payload_kg},
    });
    return members;
}

const std::vector<std::string>& track_names() {
    static const auto names = [] {
        std::vector<std::string> all;
        for (const auto& [name, member] : track_members()) all.emplace_back(name);
        return all;
    }();
    return names;
}

std::optional<double> first_value(const Track& track) {
    return track.empty() ? std::nullopt : std::optional(track.value.front());
}

std::optional<double> last_value(const Track& track) {
    return track.empty() ? std::nullopt : std::optional(track.value.back());
}

std::map<std::string, std::string> track_sources(const FlightData& data) {
    std::map<std::string, std::string> sources;
    for (const auto& [name, member] : track_members())
        if (const auto& track = data.*member; !track.empty()) sources.emplace(name, track.source);
    return sources;
}

Diagnostics selection_diagnostics(const FlightData& data) {
    using enum Severity;
    Diagnostics found;
    const auto add = [&](Severity severity, const std::string& kind, const std::vector<std::string>& texts) {
        append(found, severity, kind, data.flight, texts);
    };
    if (!data.assumed_definitions.empty()) {
        std::vector<std::string> assumed;
        for (const auto& definition : data.assumed_definitions) assumed.push_back(definition.text);
        const auto* what = data.log_is_missing ? "no .log: message layouts assumed" : "units in the .log";
        add(warning, what, {fmt::format("{}: {}", what, fmt::join(assumed, ", "))});
    }
    if (data.current_origin == CurrentOrigin::throttle)
        add(warning, "current computed from the throttle",
            {"there is no current sensor (by MILLIAMP_AT_FULL_THROTTLE of the airframe, or BATT_MONITOR = 25): the "
             "current is computed from the throttle, so a power model fitted to it is circular"});
    if (!data.power_w.empty())  // else see no_power_reason
        for (const auto& reason : data.power_w.not_chosen)
            add(warning, "unusable source of power",
                {fmt::format("{}: power is that of {}", reason, data.power_w.source)});
    add(warning, data.circuits.empty() ? "corrected power" : "power of the batteries", data.power_w.notes);
    for (const auto& [name, member] : track_members()) {
        const bool moves_phases = member == &FlightData::altitude_m || member == &FlightData::throttle_percent;
        if (member != &FlightData::power_w)
            add(moves_phases ? warning : note,
                moves_phases                                                        ? "corrected altitude or throttle"
                : member == &FlightData::airspeed_m_per_s && data.airspeed_estimate ? "estimated airspeed"
                                                                                    : "corrected tracks",
                (data.*member).notes);
    }
    if (data.airspeed_estimate) add(warning, "wrong airspeed sensor", data.airspeed_m_per_s.not_chosen);
    for (const auto& skip : data.skipped)
        is_partial_record(skip) ? add(note, "cut at power-off", {describe(skip)})
                                : add(warning, "damaged log", {describe(skip)});
    if (data.log_is_missing && data.assumed_definitions.empty()) add(note, "no .log", {"no .log"});
    add(note, "units and recordings of the log", data.notes);
    return found;
}

FlightData select_circuit(FlightData data, std::size_t number) {
    if (number == 0 || number > data.circuits.size()) {
        std::vector<std::string> names;
        for (const auto& circuit : data.circuits) names.push_back(circuit.name);
        throw InputError({data.file}, fmt::format("{} has no circuit {}", data.flight, number),
                         names.empty() ? "its log does not number batteries: leave --circuit out"
                                       : fmt::format("its circuits are, from 1: {}", fmt::join(names, ", ")));
    }
    const auto& circuit = data.circuits[number - 1];
    data.power_w = {circuit.power_w};
    data.voltage_v = {circuit.voltage_v};
    data.current_a = {circuit.current_a};
    data.charge_ah = {circuit.charge_ah};
    data.battery_temperature_c = {circuit.battery_temperature_c};
    data.stated_cells = circuit.stated_cells;
    data.monitors = circuit.monitors;
    data.energy_wh = {};
    return data;
}

std::string no_power_reason(const FlightData& data) {
    if (!data.power_w.empty()) return "";
    auto reasons = data.power_w.not_chosen;
    for (const auto& skip : data.skipped) reasons.push_back(describe(skip));
    for (const auto& assumed : data.assumed_definitions)
        reasons.push_back(fmt::format("{} {}", data.log_is_missing ? "assumed" : "the .log:", assumed.text));
    return fmt::format("{}", fmt::join(reasons, "; "));
}

void require_power(const FlightData& data, const std::string& messages) {
    if (const auto& restart = data.clock_restart) {
        const auto aircraft = data.aircraft_id.empty() ? "" : fmt::format("aircraft {}, ", data.aircraft_id);
        throw InputError({data.file},
                         fmt::format("the clock runs back from {:.3f} to {:.3f} s ({}{})", restart->from_s,
                                     restart->to_s, aircraft, restart->message),
                         "the file has several recordings that overlap: separate their lines");
    }
    if (!data.power_w.empty()) return;
    const auto reasons = no_power_reason(data);
    const auto reason = reasons.empty() ? "" : fmt::format(" ({})", reasons);
    const bool is_paparazzi = !data.aircraft_name.starts_with("Ardu") && !data.aircraft_name.starts_with("PX4");
    const auto whose = data.aircraft_id.empty() ? "" : " of aircraft " + data.aircraft_id;
    throw InputError({data.file}, fmt::format("has no measured power{}{}", whose, reason),
                     fmt::format("expected {}{}{}",
                                 is_paparazzi ? "ENERGY with power, BAT or ENERGY with current, ESC or POWER_DEVICE"
                                              : "BAT, CURR, ESC or battery_status with current",
                                 messages.empty() ? "" : "; it has ", messages));
}

}  // namespace flightwatt::flight
