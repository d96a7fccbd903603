#include "flight/sources/logged_tracks.h"

#include "base/units.h"
#include "flight/sources/made_tracks.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

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
        {"mode", "PPRZ_MODE", "ap_mode", std::nullopt, Merge::latest},
        {"block", "NAVIGATION", "cur_block", std::nullopt, Merge::latest},
        {"ground_altitude_m", "NAVIGATION_REF", "ground_alt", metre, Merge::latest},
    };
    return fields;
}

std::size_t place_of(const Track& track) {
    const auto& names = track_names();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), track.name) - names.begin());
}

}  // namespace

std::vector<Track> logged_tracks(const telemetry::SenderLog& sender, bool definitions_assumed) {
    std::vector<Track> tracks;
    for (const auto& [name, message, field, quantity, merge] : field_tracks()) {
        const auto* table = sender.table(message);
        const auto* column = table == nullptr ? nullptr : table->column(field);
        if (column == nullptr || (quantity && column->quantity != quantity)) continue;
        tracks.push_back(as_track(name, fmt::format("{}.{}", message, field), *table, column->values, merge));
    }
    add_made_tracks(tracks, sender, definitions_assumed);
    std::ranges::stable_sort(tracks, {}, place_of);
    return tracks;
}

}  // namespace flightwatt::flight
