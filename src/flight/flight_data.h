#pragma once

#include "base/diagnostic.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The track that is used for a quantity; empty if the log has none. `source` states its origin: "ENERGY.voltage *
/// ENERGY.current", "ESC, summed over 4 devices".
struct ChosenTrack : Track {
    std::vector<std::string> notes = {};       ///< removed samples, replaced intervals, unusable sources
    std::vector<std::string> not_chosen = {};  ///< sources that were rejected, with the reason
};

/// A wind over a time, as the ground velocity shows it, with the covariance of its parts [m^2/s^2].
struct EstimatedWind {
    double start_s = 0.0;  ///< the log's own seconds
    double end_s = 0.0;
    double east_m_per_s = 0.0;
    double north_m_per_s = 0.0;
    double east_variance = 0.0;
    double covariance = 0.0;
    double north_variance = 0.0;
};

/// How an airspeed was estimated that no sensor measured, and its standard deviations.
struct AirspeedEstimate {
    std::vector<EstimatedWind> winds;  ///< one after the other
    double sd_m_per_s = 0.0;           ///< of means over 30 s
    double mean_sd_m_per_s = 0.0;      ///< of the mean of the flight
};

/// A battery monitor of a vehicle, from 1 on, and the part of its circuit's charge that it counts; 0: unknown.
struct MonitorShare {
    int number = 1;
    double part = 1.0;
    bool operator==(const MonitorShare&) const = default;
};

/// Battery packs at one voltage, and the tracks of their sum.
struct Circuit {
    std::string name;  ///< its battery monitors: "BAT 0 and BAT 1"
    double mean_power_w = 0.0;
    Track power_w = {};
    Track voltage_v = {};  ///< of the pack with the most power
    Track current_a = {};
    Track charge_ah = {};
    std::optional<double> stated_capacity_ah = {};  ///< of its packs together, if the log's parameters state each
    Track battery_temperature_c = {};               ///< of the pack with the most power
    std::optional<int> stated_cells = {};           ///< in series, by the log, where its packs agree
    std::vector<MonitorShare> monitors = {};        ///< of its packs, by number
};

/// One flight's log with the track that is used for each quantity: what all steps after the selection read. Made by
/// select_tracks() alone. Voltage, current, charge and temperature are those of the first circuit; power and energy are of all.
struct FlightData : FlightInfo {
    ChosenTrack altitude_m;
    ChosenTrack throttle_percent;
    ChosenTrack voltage_v;
    ChosenTrack current_a;
    ChosenTrack power_w;
    ChosenTrack charge_ah;
    ChosenTrack energy_wh;
    ChosenTrack east_m;
    ChosenTrack north_m;
    ChosenTrack ground_speed_m_per_s;
    ChosenTrack airspeed_m_per_s;
    ChosenTrack wind_speed_m_per_s;
    ChosenTrack wind_east_m_per_s;
    ChosenTrack wind_north_m_per_s;
    ChosenTrack latitude_deg;
    ChosenTrack longitude_deg;
    ChosenTrack heading_deg;
    ChosenTrack course_deg;
    ChosenTrack climb_m_per_s;
    ChosenTrack roll_deg;
    ChosenTrack air_temperature_c;
    ChosenTrack battery_temperature_c;
    ChosenTrack motor_speed_rpm;
    ChosenTrack mass_kg;
    ChosenTrack rotor_area_m2;
    ChosenTrack mode;
    ChosenTrack block;
    ChosenTrack rover_mode;
    ChosenTrack takeoff;
    ChosenTrack armed;
    ChosenTrack landed;
    ChosenTrack fix;         ///< 1: the position has a 3D fix
    ChosenTrack vtol_state;  ///< see VtolState
    ChosenTrack ground_altitude_m;
    ChosenTrack payload_kg;

    /// Of an airspeed that was estimated (select/airspeed.h); absent if it was measured, or is unknown.
    std::optional<AirspeedEstimate> airspeed_estimate;

    std::optional<double> stated_capacity_ah;  ///< of the packs of the first circuit, by the log's parameters
    std::optional<int> stated_cells;           ///< likewise, in series
    std::vector<MonitorShare> monitors;        ///< of the packs of the circuit of these tracks; empty: not numbered

    std::vector<Circuit> circuits;  ///< those of a log that numbers its batteries, the one with the most energy first
    std::vector<Track> other_altitudes;                        ///< candidates of the altitude that were not chosen
    double last_s = -std::numeric_limits<double>::infinity();  ///< see last_time_s()

    bool is_rotorcraft() const { return firmware == "rotorcraft"; }
    bool airspeed_is_measured() const { return !airspeed_m_per_s.empty() && !airspeed_estimate; }
};

/// A quantity, and the member of FlightData that has it.
struct TrackMember {
    std::string_view name;
    ChosenTrack FlightData::*track;
};

/// Returns all quantities, in the order of the series file's columns.
std::span<const TrackMember> track_members();

/// Returns their names, which are those of the tracks of a FlightSeries.
const std::vector<std::string>& track_names();

/// Returns the first value of a track; std::nullopt for an empty one.
std::optional<double> first_value(const Track& track);
/// Returns the last value of a track; std::nullopt for an empty one.
std::optional<double> last_value(const Track& track);

/// Returns the source of each track that the flight has, by the name of the track.
std::map<std::string, std::string> track_sources(const FlightData& data);

/// Returns the findings about the log and the choice of its tracks: assumed layouts, rejected sources, removed samples,
/// skipped lines.
Diagnostics selection_diagnostics(const FlightData& data);

/// Returns the data with voltage, current, charge and power of one circuit, counted from 1. Throws InputError if it has
/// no such circuit.
FlightData select_circuit(FlightData data, std::size_t number);

/// Returns the reason why there is no measured power; empty if there is.
std::string no_power_reason(const FlightData& data);

/// Throws InputError if there is no measured power, or several recordings are in one log. The error lists `messages`,
/// which the log has instead.
void require_power(const FlightData& data, const std::string& messages = "");

}  // namespace flightwatt::flight
