#pragma once

#include "live/live_flight.h"

#include <string>

namespace flightwatt::live {

/// Phase and times of the last sortie as it looks at `now_s`. A climb that has not held its height yet is a take-off;
/// an aircraft has landed when it keeps its height after the touchdown for as long as a rest takes, as it may touch and
/// go, or when nothing more of it comes (`is_over`).
void update_flight_times(const flight::Sortie& sortie, const flight::Track& altitude_m, double now_s, bool is_over,
                         LiveState& state);

/// What lies before is not needed any more: in a sortie five minutes before its lift-off, on the ground ten minutes ago
/// (but all of a sortie that reaches into them).
double retention_start_s(const flight::FlightPhases& phases, const LiveState& state);

/// An error's text without "FLIGHT: " before it.
std::string without_flight_name(const std::string& text, const std::string& flight);

}  // namespace flightwatt::live
