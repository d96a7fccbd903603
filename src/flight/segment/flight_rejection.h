#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/segment/flight_grid.h"
#include "flight/segment/phase_edges.h"

#include <string>

namespace flightwatt::flight {

/// An activity that may be a flight, with its data.
struct FlightCandidate {
    const FlightData& data;
    const ResampledFlight& grid;
    const Activity& activity;
    const Heights& heights;
    const SegmentationOptions& options;

    double max_motor_percent() const;
    bool is_motor_off() const;  ///< false if unknown
};

/// Why the vehicle does not fly: "a ground vehicle: it sends ROVER_STATUS"; empty otherwise.
std::string ground_vehicle_reason(const FlightData& data);

/// Why an activity is not a flight, by the rules of flight_rejection.cpp (docs/methods.md); empty if it is one.
std::string no_flight_reason(const FlightCandidate& candidate);

/// Warning about a flight with the motor off by its indicator; empty without this contradiction.
std::string motor_contradiction(const FlightCandidate& candidate);

}  // namespace flightwatt::flight
