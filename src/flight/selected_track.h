#pragma once

#include "flight/flight_series.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The track of that name that the programs compute with: the first candidate that varies, else the first that has
/// values. Exceptions: of airspeed one that varies or none (without a sensor it is constant); of ground speed the
/// first; of throttle a rotorcraft's thrust comes last, and a fraction is made percent; of current and power the sum
/// over devices where no message tells the whole. Power is the first that measures something (is not 0 throughout) and
/// is not contradicted by voltage times current. Samples that cannot be are left out, and said in warnings_of: those
/// beyond physical bounds (sources/outliers.h), of power, voltage and current where the message contradicts itself, and
/// lonely spikes (docs/methods.md). Empty if the log has none. `source` says where it is from:
/// "ENERGY.voltage * ENERGY.current", "ESC, summed over 4 devices".
Track select_track(const FlightSeries& series, std::string_view name);

/// The chosen tracks of a series, each made when it is first asked for. The series must outlive it, and stay as it is.
/// What takes selected tracks takes a series too; several calls share the tracks if they are given them.
class SelectedTracks {
  public:
    SelectedTracks(const FlightSeries& series) : series_(series) {}

    const FlightSeries& series() const { return series_; }
    const Track& operator[](std::string_view name) const { return choice(name).track(); }
    const TrackSelection& choice(std::string_view name) const;
    /// Makes all that are not made yet, of a long series on all cores: for who will ask for most of them.
    void compute_all() const;

  private:
    const FlightSeries& series_;
    mutable std::map<std::string, TrackSelection, std::less<>> made_;
};

/// The track of that name at other times, linear between its points and constant outside; `time_s` must rise.
/// Empty if the log has none.
std::vector<double> sample_selected_track(const SelectedTracks& tracks, std::string_view name,
                                          const std::vector<double>& time_s);

/// A throttle at idle is contradicted by power, or by the commands to the motor, that last so long [s].
inline constexpr double contradicted_s = 30.0;

/// The power samples, whose clock most programs compute on.
inline Track power_track(const FlightSeries& series) { return select_track(series, "power_w"); }

/// Where each chosen track came from, by name.
std::map<std::string, std::string> track_sources(const SelectedTracks& tracks);

/// Above sea level, from the log's NAVIGATION_REF, else as planned; 0 where altitudes are above the ground.
std::optional<double> ground_altitude_m(const SelectedTracks& tracks);

/// What a user should know: assumed layouts, sources passed over, samples left out, skipped lines.
std::vector<std::string> warnings_of(const SelectedTracks& tracks);

/// Why no power was measured: what was looked at and what is wrong with it, "ENERGY.power is 0 throughout; ...". Empty
/// if power was measured, or where nothing tells of it.
std::string no_power_reason(const FlightSeries& series);

/// Throws InputError where the clock began anew, or where no power was measured: it says what was looked at
/// and, with `holds`, what the log holds instead.
void require_power(const FlightSeries& series, const std::string& holds = "");

}  // namespace flightwatt::flight
