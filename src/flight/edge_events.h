#pragma once

#include "flight/flight_phases.h"
#include "flight/selected_track.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The four edges of a sortie.
enum class EdgeKind { lift_off, takeoff_end, landing_start, touchdown };

std::string_view to_string(EdgeKind kind);

/// An event of the autopilot near an edge, and its distance from the edge that altitude and throttle give.
struct EdgeEvent {
    std::string what;  ///< "TAKEOFF", "mode 2 -> 1", "block Takeoff -> Standby"
    double time_s = 0.0;
    double after_s = 0.0;  ///< time of the event less that of the edge
};

/// An edge compared with events of the autopilot.
struct EdgeReport {
    EdgeKind kind = EdgeKind::lift_off;
    PhaseEdge edge;
    double height_percent = 0.0;             ///< of the flight's height, above the ground before it
    std::vector<EdgeEvent> matching_events;  ///< events that mark this edge, the best one first
    std::vector<EdgeEvent> other_events;     ///< nearby events that mark another moment
    std::string agreement;                   ///< of the first matching event: "agrees", "differs by 12 s", "no event"
};

/// Maximum distance of an event that agrees with an edge [s].
inline constexpr double agreement_s = 5.0;
/// Maximum distance of an event that belongs to an edge [s].
inline constexpr double max_event_distance_s = 60.0;

/// The logged edges of a sortie, in order. Matching events: of lift-off TAKEOFF messages; of the landing's start a
/// block named landing and the change from AUTO2. No event marks the other two edges (the take-off block and AUTO2
/// depend on the flight plan or pilot, MANUAL comes long after touchdown), so theirs are only listed.
std::vector<EdgeReport> compare_edges_with_events(const SelectedTracks& tracks, const Sortie& sortie);

}  // namespace flightwatt::flight
