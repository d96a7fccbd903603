#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Hover, transitions and wing flight of VTOL aircraft, as their autopilots state them.
namespace flightwatt::flight {

/// How a VTOL flies. Of ArduPilot's logs, which state only that the lift motors run, hover includes transitions.
enum class VtolFlight { hover, transition, wing };

/// Returns its name: "hover", "transition" or "wing".
std::string_view to_string(VtolFlight flight);

/// An interval of one kind of flight.
struct VtolSpan : TimeInterval {
    VtolFlight flight = VtolFlight::hover;
};

/// Returns how a VTOL flies between two times, in order; empty for other aircraft.
std::vector<VtolSpan> vtol_spans(const FlightData& data, double start_s, double end_s);

/// Returns whether an aircraft is on its wing throughout an interval; true for one that is no VTOL.
bool is_on_wing(const FlightData& data, double start_s, double end_s);

/// Returns the time from the first to the last wing flight of a VTOL between two times; std::nullopt without any.
std::optional<TimeInterval> wing_flight(const FlightData& data, double start_s, double end_s);

/// Returns whether a VTOL is never on its wing in a sortie; false for other aircraft.
bool only_hovers(const FlightData& data, const Sortie& sortie);

/// Returns a warning of hover or transitions within the cruise of a VTOL, or instead of it; empty without.
std::string hover_in_cruise(const FlightData& data, const Sortie& sortie);

/// Returns the duration, energy and mean power of each kind of flight of a VTOL's sortie: "hover 35 s, 5.95 Wh, 612 W;
/// ..."; empty for other aircraft.
std::string describe_vtol(const FlightData& data, const Sortie& sortie);

}  // namespace flightwatt::flight
