#include "flight/sources/logged_tracks.h"

#include "base/units.h"
#include "flight/sources/device_tracks.h"
#include "flight/sources/power_source.h"
#include "flight/sources/utm.h"
#include "flight/track.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

using telemetry::Column;
using telemetry::MessageTable;
using telemetry::SenderLog;
using units::Quantity;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // make_track drops it

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

Track as_track(const char* name, std::string source, const MessageTable& table,
               const std::vector<double>& values, Merge merge) {
    auto track = make_track(table.time_s, values, merge);
    track.name = name;
    track.source = std::move(source);
    track.since_s = *std::min_element(table.time_s.begin(), table.time_s.end());
    return track;
}

void add_fields(std::vector<Track>& tracks, const SenderLog& sender) {
    for (const auto& [name, message, field, quantity, merge] : field_tracks()) {
        const auto* table = sender.table(message);
        const auto* column = table == nullptr ? nullptr : table->column(field);
        if (column == nullptr || (quantity && column->quantity != quantity)) continue;
        tracks.push_back(as_track(name, fmt::format("{}.{}", message, field), *table, column->values, merge));
    }
}

/// A track that is made of several fields of one message, row by row; nothing where one is missing.
void add_made(std::vector<Track>& tracks, const SenderLog& sender, const char* name, const char* message,
              std::initializer_list<const char*> fields, std::string source,
              const std::function<double(const std::vector<double>&)>& make) {
    const auto* table = sender.table(message);
    if (table == nullptr) return;
    std::vector<const Column*> columns;
    for (const auto* field : fields) {
        columns.push_back(table->column(field));
        if (columns.back() == nullptr) return;
    }
    std::vector<double> values(table->time_s.size());
    std::vector<double> row(columns.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t c = 0; c < columns.size(); ++c) row[c] = columns[c]->values[i];
        values[i] = make(row);
    }
    tracks.push_back(as_track(name, std::move(source), *table, values, Merge::mean));
}

void add_products(std::vector<Track>& tracks, const SenderLog& sender) {
    for (const auto* message : {"ENERGY", "BAT"}) {
        const auto* table = sender.table(message);
        if (table == nullptr) continue;
        const auto [voltage, current] = voltage_and_current(*table);
        if (voltage == nullptr || current == nullptr) continue;
        tracks.push_back(as_track("power_w",
                                  fmt::format("{0}.{1} * {0}.{2}", message, voltage->field, current->field),
                                  *table, products(voltage->values, current->values), Merge::mean));
    }
}

/// The last two fields of a 4-field ENERGY, read the other way round.
void add_exchanged(std::vector<Track>& tracks, const SenderLog& sender) {
    const auto* table = sender.table("ENERGY");
    if (table == nullptr || table->columns.size() != 4) return;
    const auto* energy = table->column("energy");
    const auto* power = table->column("power");
    if (energy == nullptr || power == nullptr || table->column("bat") == nullptr ||
        table->column("amp") == nullptr) {
        return;
    }
    constexpr double raw_per_ah = 1000.0;  // the column was read as mAh
    std::vector<double> watts = energy->values;
    for (auto& value : watts) value *= raw_per_ah;
    std::vector<double> ampere_hours = power->values;
    for (auto& value : ampere_hours) value /= raw_per_ah;
    tracks.push_back(as_track("power_w", energy_read_as_power, *table, watts, Merge::mean));
    tracks.push_back(as_track("charge_ah", power_read_as_energy, *table, ampere_hours, Merge::latest));
}

/// 0 east and 0 north says that the aircraft does not know the wind yet.
double wind_speed(const std::vector<double>& east_north) {
    const double speed = std::hypot(east_north[0], east_north[1]);
    return speed > 0.0 ? speed : unknown;
}

void add_made_tracks(std::vector<Track>& tracks, const SenderLog& sender) {
    // Rotorcraft before 2018: thrust, without a unit, on Paparazzi's command scale.
    add_made(tracks, sender, "throttle_percent", "ROTORCRAFT_FP", {"thrust"}, "ROTORCRAFT_FP.thrust",
             [](const auto& row) { return units::percent_from_pprz(row[0]); });
    add_made(tracks, sender, "ground_speed_m_per_s", "GPS_INT", {"ecef_xd", "ecef_yd", "ecef_zd"},
             "GPS_INT.ecef velocity", [](const auto& row) { return std::hypot(row[0], row[1], row[2]); });
    const auto* wind = sender.table("WIND_INFO");
    const auto* east = wind == nullptr ? nullptr : wind->column("east");
    if (east != nullptr && east->quantity == Quantity::metre_per_second) {
        add_made(tracks, sender, "wind_speed_m_per_s", "WIND_INFO", {"east", "north"},
                 "WIND_INFO.east, north", wind_speed);
    }
    const auto position = [](const auto& row) { return position_of_utm(row[0], row[1], row[2]); };
    add_made(tracks, sender, "latitude_deg", "GPS", {"utm_east", "utm_north", "utm_zone"}, "GPS.utm",
             [&](const auto& row) { return position(row).latitude_deg; });
    add_made(tracks, sender, "longitude_deg", "GPS", {"utm_east", "utm_north", "utm_zone"}, "GPS.utm",
             [&](const auto& row) { return position(row).longitude_deg; });
    if (const auto* takeoff = sender.table("TAKEOFF"); takeoff != nullptr && !takeoff->empty()) {
        const std::vector<double> ones(takeoff->time_s.size(), 1.0);
        tracks.push_back(as_track("takeoff", "TAKEOFF", *takeoff, ones, Merge::latest));
    }
}

std::size_t place_of(const Track& track) {
    const auto& names = track_names();
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), track.name) - names.begin());
}

}  // namespace

std::vector<Track> logged_tracks(const SenderLog& sender, bool definitions_assumed) {
    std::vector<Track> tracks;
    add_fields(tracks, sender);
    add_products(tracks, sender);
    if (definitions_assumed) add_exchanged(tracks, sender);
    add_made_tracks(tracks, sender);
    add_device_tracks(tracks, sender);
    std::stable_sort(tracks.begin(), tracks.end(),
                     [](const Track& a, const Track& b) { return place_of(a) < place_of(b); });
    return tracks;
}

}  // namespace flightwatt::flight
