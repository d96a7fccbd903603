#pragma once

#include "flight/flight_phases.h"
#include "flight/selected_track.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// What a sortie's four edges are called.
enum class EdgeKind { lift_off, takeoff_end, landing_start, touchdown };

std::string_view to_string(EdgeKind kind);

/// What the autopilot says of an edge: when, and how far from where altitude and throttle put it.
struct EdgeEvent {
    std::string what;  ///< "TAKEOFF", "mode 2 -> 1", "block Takeoff -> Standby"
    double time_s = 0.0;
    double after_s = 0.0;  ///< the witness's time less the edge's
};

/// An edge with its reasons. The first witness is the best of its kind, and the verdict is about it.
struct EdgeReport {
    EdgeKind kind = EdgeKind::lift_off;
    PhaseEdge edge;
    double height_percent = 0.0;             ///< of the flight's own height, above the ground before it
    std::vector<EdgeEvent> matching_events;  ///< events that mark this edge
    std::vector<EdgeEvent> other_events;     ///< events about it that mark another moment
    std::string agreement;                   ///< "agrees", "differs by 12 s" or "no witness"
};

/// A witness this near to an edge agrees with it.
inline constexpr double agreement_s = 5.0;
/// A witness further away than this speaks of something else.
inline constexpr double max_event_distance_s = 60.0;

/// The edges that the log shows of a sortie, in order. Witnesses are: of lift-off TAKEOFF messages; of the
/// landing's start a block called landing and the change from AUTO2. Nothing that the autopilot says marks
/// the other two edges, so they have no witness and their events are only listed: the block called take-off
/// is left and AUTO2 begins where the flight plan or the pilot says, at a fraction of the height flown; and
/// the pilot takes the switch to MANUAL when the aircraft has long come to rest.
std::vector<EdgeReport> compare_edges_with_events(const SelectedTracks& tracks, const Sortie& sortie);

}  // namespace flightwatt::flight
