#pragma once

#include "flight/flight_data.h"

/// The airspeed of a wing without a sensor, or with a wrong one, from its velocity over ground.
///
/// In a steady wind w the velocities v over ground are on a circle about w, where the airspeed is equal on all headings.
/// The circle with the least (robust) variance of |v - w| gives the wind, and |v - w| the airspeed of each moment.
/// Headings of the compass are not used: many autopilots take them from the course, which shows no wind; nor is power,
/// from which a power model of that airspeed would be circular.
///
/// What the ground velocity cannot show: an airspeed that differs with the heading by d moves the wind by d. A part of
/// the airspeed is added to the error for that, and gusts (constants in airspeed.cpp).
namespace flightwatt::flight {

/// Estimates the airspeed of a wing that has none, or whose sensor the ground velocity disproves, and its wind where the
/// log has none: of parts of the flight of ten minutes or more. Sets airspeed_estimate; the airspeed's `not_chosen` has
/// the reason against the estimate, or with one that against the sensor.
void estimate_airspeed(FlightData& data);

}  // namespace flightwatt::flight
