#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/segment/flight_grid.h"
#include "flight/segment/phase_edges.h"

#include <string>

namespace flightwatt::flight {

/// An activity that may be a flight, with the data that decide it.
struct FlightCandidate {
    const FlightData& data;
    const ResampledFlight& grid;
    const Activity& activity;
    const Heights& heights;
    const SegmentationOptions& options;

    /// Returns the maximum of motor_percent in the activity.
    double max_motor_percent() const;
    /// Returns whether the motor is off in the activity; false if unknown.
    bool is_motor_off() const;
};

/// Returns whether a wing cruises level for a minute or more, from the beginning of its log to the end: without a rest,
/// with the motor of a flight, at flying speed.
bool is_cruise_alone(const FlightCandidate& candidate);

/// Returns the reason why the vehicle does not fly, "a ground vehicle: it sends ROVER_STATUS"; empty if it may.
std::string ground_vehicle_reason(const FlightData& data);

/// Returns the reason why an activity is not a flight, by the rules of flight_rejection.cpp (docs/methods.md); empty if
/// it is one.
std::string no_flight_reason(const FlightCandidate& candidate);

/// Returns a warning about a flight during which the motor is off by its indicator; empty without this contradiction.
std::string motor_contradiction(const FlightCandidate& candidate);

}  // namespace flightwatt::flight
