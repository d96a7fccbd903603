#pragma once

#include "flight/flight_series.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The track of that name that is used: the first candidate that varies, else the first with values; empty if the log
/// has none. `source` states its origin: "ENERGY.voltage * ENERGY.current", "ESC, summed over 4 devices". Outliers are
/// removed (sources/outliers.h). Exceptions are power (select_power), current and voltage of several devices, throttle
/// (commands, thrust and fractions), ground speed (the first) and a constant airspeed (no sensor: empty).
Track select_track(const FlightSeries& series, std::string_view name);

/// The selected tracks of a series, each computed at its first use. The series must outlive it, unchanged. Functions
/// that take SelectedTracks accept a series too; passing the same SelectedTracks to several calls avoids recomputation.
class SelectedTracks {
  public:
    SelectedTracks(const FlightSeries& series) : series_(series) {}

    const FlightSeries& series() const { return series_; }
    const Track& operator[](std::string_view name) const { return choice(name).track; }
    const TrackSelection& choice(std::string_view name) const;

  private:
    const FlightSeries& series_;
    mutable std::map<std::string, TrackSelection, std::less<>> choices_;
};

/// The track of that name at other times, linear between its points and constant outside; `time_s` must rise.
/// Empty if the log has none.
std::vector<double> sample_selected_track(const SelectedTracks& tracks, std::string_view name,
                                          const std::vector<double>& time_s);

/// An idle throttle is contradicted by power, or by commands to the motor, for at least this time [s].
inline constexpr double contradicted_s = 30.0;

/// The power samples, whose clock is that of most calculations.
inline Track power_track(const FlightSeries& series) { return select_track(series, "power_w"); }

/// Source of each selected track, by name.
std::map<std::string, std::string> track_sources(const SelectedTracks& tracks);

/// Ground level above the sea, from NAVIGATION_REF, else as planned; 0 if altitudes are above the ground.
std::optional<double> ground_altitude_m(const SelectedTracks& tracks);

/// What the aircraft carries beyond its own mass at the beginning, if its file or column map states it (track
/// payload_kg).
std::optional<double> payload_kg(const FlightSeries& series);

/// Warnings for the user: assumed layouts, rejected sources, removed samples, skipped lines.
std::vector<std::string> warnings_of(const SelectedTracks& tracks);

/// Why there is no measured power: the rejected sources, "ENERGY.power is 0 throughout; ...". Empty if power was
/// measured, and without any source.
std::string no_power_reason(const FlightSeries& series);

/// Throws InputError if the clock restarts or there is no measured power; `messages` of the log are listed in it.
void require_power(const FlightSeries& series, const std::string& messages = "");

}  // namespace flightwatt::flight
