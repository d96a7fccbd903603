#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"
#include "flight/segmentation/flight_grid.h"
#include "flight/segmentation/phase_edges.h"
#include "flight/selected_track.h"

#include <string>

namespace flightwatt::flight {

/// A small aircraft climbs or dives no faster than this for 5 s, and than that for 30 s [m/s].
inline constexpr double max_climb_5_s_m_per_s = 60.0;
inline constexpr double max_climb_30_s_m_per_s = 30.0;
/// An altitude that moves as far as a flight is contradicted by a GPS that moves by less than this part of it, and by
/// less than half of the least height of a flight, unless another altitude moves by the other part of it.
inline constexpr double max_gps_motion_fraction = 0.25;
inline constexpr double min_confirming_fraction = 0.5;
/// Without ground in sight and at one height, what never gets faster than this is no fixed wing [m/s].
inline constexpr double min_flight_m_per_s = 5.0;
/// What altitude alone shows to be flown, with nothing that tells of the motor, stays above half of its height for so
/// long [s], and (where no speed is known either) rises to so many times the least height of a flight.
inline constexpr double min_time_aloft_s = 15.0;
inline constexpr double min_height_factor = 2.0;
/// From ground to ground no aircraft stays below this slope (and so many metres that its altitude may be off).
inline constexpr double road_slope = 0.03;
inline constexpr double road_slack_m = 2.0;

/// Position is compared over this time; with an airspeed, what stays within this extent stands [s, m].
inline constexpr double position_window_s = 10.0;
inline constexpr double standing_extent_m = 30.0;
/// The motor runs, whatever the throttle says, where at this airspeed for this time so much height (or the energy of as
/// much) is gained [m/s, s, m]. A thermal does the same: that is flight, too.
inline constexpr double least_airspeed_m_per_s = 7.0;
inline constexpr double climb_window_s = 20.0;
inline constexpr double climbed_by_motor_m = 15.0;

/// Why the vehicle is none that flies; empty if that is not said: "a ground vehicle: it sends ROVER_STATUS".
std::string ground_vehicle_reason(const SelectedTracks& tracks);

/// Why an activity is no flight; empty if it is one.
std::string no_flight_reason(const SelectedTracks& tracks, const ResampledFlight& grid, const Activity& activity,
                             const Heights& heights, const SegmentationOptions& options);

/// What contradicts the motor of an activity that is a flight: "ENERGY.throttle says that the motor is off ..."; empty
/// if nothing does.
std::string motor_doubt(const ResampledFlight& grid, const Activity& activity, const SegmentationOptions& options);

/// Whether the altitude moves, all in all, much more or less than the climb rate or another altitude of the log says:
/// "ESTIMATOR.z moves 100 times as much as GPS.alt says: is one of them in cm?"; empty if it does not.
std::string suspected_unit_error(const SelectedTracks& tracks, const ResampledFlight& grid);

}  // namespace flightwatt::flight
