#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"
#include "flight/segmentation/activity.h"
#include "flight/segmentation/flight_grid.h"

#include <string>

namespace flightwatt::flight {

/// A small aircraft climbs or dives no faster than this for 5 s, and than that for 30 s [m/s].
inline constexpr double fastest_5_s_m_per_s = 60.0;
inline constexpr double fastest_30_s_m_per_s = 30.0;
/// An altitude that moves as far as a flight is contradicted by a GPS that moves by less than this part of it, and by
/// less than half of the least height of a flight, unless another altitude moves by the other part of it.
inline constexpr double contradicting_part = 0.25;
inline constexpr double confirming_part = 0.5;
/// Without ground in sight and at one height, what never gets faster than this is no fixed wing [m/s].
inline constexpr double slowest_flight_m_per_s = 5.0;

/// Why the vehicle is none that flies; empty if that is not said: "a ground vehicle: it sends ROVER_STATUS".
std::string why_ground_vehicle(const FlightSeries& series);

/// Why an activity is no flight; empty if it is one.
std::string why_no_flight(const FlightSeries& series, const FlightGrid& grid, const Activity& activity,
                          const Heights& heights, const SegmentationOptions& options);

/// Whether the altitude moves, all in all, much more or less than the climb rate or another altitude of the log says:
/// "ESTIMATOR.z moves 100 times as much as GPS.alt says: is one of them in cm?"; empty if it does not.
std::string unit_doubt(const FlightSeries& series, const FlightGrid& grid);

}  // namespace flightwatt::flight
