#pragma once

#include "base/error.h"
#include "mission/schedule.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// One entry of a schedule as it was written.
struct ScheduleEntry {
    std::optional<flight::Phase> phase;  ///< none: any phase (only with otherwise)
    bool otherwise = false;              ///< what no explicit entry covers
    bool whole_phase = false;            ///< explicit, and without from, to or middle
    double start_s = 0.0;                ///< since the phase began; not read if otherwise
    double end_s = 0.0;
    compute::Configuration run;
    Location where;
};

/// Segments in order that cover each instant of each phase exactly once: the explicit entries, then for what
/// they leave of a phase its `otherwise`, then the mission's. `entries` is not empty. Throws InputError for
/// two explicit entries at the same time, a gap that no `otherwise` fills, or an `otherwise` that is there
/// twice or has nothing left to cover.
std::vector<ScheduleSegment> resolve_schedule(const std::vector<ScheduleEntry>& entries,
                                              const flight::PerPhase<double>& duration_s);

/// The segments of the explicit entries alone, in order: what is fixed of a schedule yet to be planned.
/// Throws InputError for two entries at the same time, and for `otherwise`, which would leave nothing to
/// plan.
std::vector<ScheduleSegment> resolve_fixed_segments(const std::vector<ScheduleEntry>& entries,
                                                    const flight::PerPhase<double>& duration_s);

}  // namespace flightwatt::mission
