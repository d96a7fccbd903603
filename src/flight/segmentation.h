#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The few physical thresholds of the segmentation.
struct SegmentationOptions {
    double rest_s = 10.0;                ///< an aircraft rests when, for this long, its motor idles and
    double rest_height_m = 3.0;          ///< its altitude stays within this range
    double rest_speed_m_per_s = 4.0;     ///< and (where known) it is no faster than someone who carries it
    double idle_throttle_percent = 5.0;  ///< idle is up to this (above the log's least, where speed is known)
    double flight_throttle_percent = 20.0;  ///< what rises without ever using as much is no flight
    double flight_height_m = 10.0;          ///< what stays below this is a run-up, a taxi or a hop
    double ground_fraction = 0.025;         ///< of the flight's height: below, it stands or rolls
    double cruise_fraction = 0.90;          ///< of the height held: there take-off ends and landing begins
    double hold_s = 30.0;                   ///< a height is held when it grows for this long by less than
    double hold_fraction = 0.10;            ///< this fraction of the flight's height
};

/// Where a phase begins or ends, and what was seen there.
struct PhaseEdge {
    double time_s = 0.0;
    double altitude_m = 0.0;
    double gap_s = 0.0;  ///< between the altitude samples around it: the edge lies somewhere in there
    std::optional<double> throttle_percent;
    std::optional<int> mode;                ///< PPRZ_MODE.ap_mode
    std::optional<int> block;               ///< NAVIGATION.cur_block
    std::optional<double> takeoff_after_s;  ///< the nearest TAKEOFF message, in seconds after this edge
};

/// One phase of a sortie, in the log's own seconds.
struct PhaseSpan {
    Phase phase = Phase::cruise;
    PhaseEdge start;
    PhaseEdge end;
    bool complete = true;       ///< false if the log begins or ends inside of it
    double duration_s() const;  ///< rounded to the millisecond, as its edges are
};

/// From lift-off to touchdown.
struct Sortie {
    std::size_t number = 1;         ///< its place among those of the log
    std::vector<PhaseSpan> phases;  ///< in order; a log that begins or ends in the air lacks some
    double ground_altitude_m = 0.0;
    double height_m = 0.0;  ///< median height above the ground while in the upper half of it
};

/// Something that moved or ran on the ground and is no flight.
struct GroundEvent {
    double start_s = 0.0;
    double end_s = 0.0;
    std::string what;  ///< "run-up: throttle to 65 %, height 0.4 m"
};

struct FlightPhases {
    std::vector<Sortie> sorties;
    std::vector<GroundEvent> ground_events;
    std::vector<std::string> warnings;
};

/// Throws UsageError for thresholds that make no sense.
void validate(const SegmentationOptions& options);

/// Finds every sortie of the series, and its phases, by altitude and throttle. An aircraft flies between two
/// rests; lift-off is where it last leaves the ground on its way up, touchdown where it first is back for
/// good; take-off ends where it reaches, and landing begins where it leaves, the height that it holds after
/// and before. TAKEOFF, mode and block are noted as witnesses and decide nothing. Throws InputError where the
/// series has no altitude.
FlightPhases segment(const FlightSeries& series, const SegmentationOptions& options = {});

/// Throws InputError saying what the log shows instead, if there is no sortie. `file` is named in it.
void require_sortie(const FlightSeries& series, const FlightPhases& phases, const std::string& file);

}  // namespace flightwatt::flight
