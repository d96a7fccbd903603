#pragma once

#include "flight/flight_phases.h"
#include "flight/segmentation/flight_grid.h"
#include "flight/segmentation/phase_edges.h"
#include "flight/selected_track.h"

#include <string>

namespace flightwatt::flight {

/// An activity that may be a flight, and what there is to know of it.
struct FlightCandidate {
    const SelectedTracks& tracks;
    const ResampledFlight& grid;
    const Activity& activity;
    const Heights& heights;
    const SegmentationOptions& options;

    double max_motor_percent() const;
    bool is_motor_off() const;  ///< as far as something tells of it
};

/// Why the vehicle is none that flies; empty if that is not said: "a ground vehicle: it sends ROVER_STATUS".
std::string ground_vehicle_reason(const SelectedTracks& tracks);

/// Why an activity is no flight; empty if it is one. By the table of flight_rejection.cpp (docs/methods.md).
std::string no_flight_reason(const FlightCandidate& candidate);

/// What contradicts the motor of an activity that is a flight: "ENERGY.throttle says that the motor is off ..."; empty
/// if nothing does.
std::string motor_doubt(const FlightCandidate& candidate);

/// Whether the altitude moves, all in all, much more or less than the climb rate or another altitude of the log says:
/// "ESTIMATOR.z moves 100 times as much as GPS.alt says: is one of them in cm?"; empty if it does not.
std::string suspected_unit_error(const SelectedTracks& tracks, const ResampledFlight& grid);

}  // namespace flightwatt::flight
