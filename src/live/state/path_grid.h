#pragma once

#include "flight/selected_track.h"
#include "live/turn_home.h"
#include "mission/remaining_path.h"

#include <cstddef>
#include <vector>

namespace flightwatt::live {

struct PathPoint {
    Displacement at;
    Displacement course;  ///< of length 1, or 0 where it is not known
    bool is_unconstrained = false;
};

/// Places along a path, evenly in its planned time.
struct PathGrid {
    std::vector<PathPoint> of;
    double step_s = 0.0;
};

/// Of a path that takes some time.
PathGrid make_path_grid(const mission::PathForecast& path);

/// Where a flight was seen, from where its cruise began.
struct Observation {
    Displacement at;
    Displacement course;  ///< of length 1, or 0 where it is not known
    bool is_known = false;

    friend bool operator==(const Observation&, const Observation&) = default;
};

/// Positions of the cruise at times `step_s` apart, from its start until a moment.
struct Observations {
    std::vector<Observation> of;
    std::size_t settled = 0;  ///< the first of them: positions lie so far behind them that late ones change none
};

/// `observations` is filled anew. None where the log has no positions, or none where the cruise began.
void collect_observations(const flight::SelectedTracks& tracks, double start_s, double until_s, double step_s,
                          Observations& observations);

Displacement minus(const Displacement& a, const Displacement& b);
double dot(const Displacement& a, const Displacement& b);

}  // namespace flightwatt::live
