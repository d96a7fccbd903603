#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "mission/schedule.h"

#include <optional>
#include <string_view>
#include <vector>

/// The [[schedule]] of a mission file (docs/missions.md).
namespace flightwatt::mission {

/// One entry of a schedule as it was written.
struct ScheduleEntry {
    std::optional<Phase> phase;  ///< absent: any phase (only with otherwise)
    bool otherwise = false;      ///< the entry is for the time that no explicit entry covers
    bool whole_phase = false;    ///< the entry is explicit, without from, to or middle
    double start_s = 0.0;        ///< time since the phase began; unused if otherwise
    double end_s = 0.0;
    compute::Configuration run;
    Location where;
};

/// Reads the [[schedule]] of a mission file (docs/missions.md). Throws InputError for an unknown phase, component,
/// parameter or key, a parameter missing or out of its profile's range, and a segment that is empty or not within
/// its phase.
std::vector<ScheduleEntry> read_schedule(const TomlTable& mission, const compute::ComputeModel& compute,
                                         const PerPhase<double>& duration_s);

/// Returns segments in order that cover each instant of each phase exactly once: the explicit entries, then for the
/// rest of a phase its `otherwise`, then that of the mission. `entries` is not empty. Throws InputError for two
/// explicit entries at the same time, a gap that no `otherwise` fills, or an `otherwise` that is stated twice or has
/// nothing left to cover.
Schedule resolve_schedule(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s);

/// Returns the segments of the explicit entries, in order: the fixed part of a schedule to be planned. Throws
/// InputError for two entries at the same time, and for `otherwise`, which would leave nothing to plan.
Schedule resolve_fixed_segments(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s);

/// Reads the key `phase`. Throws InputError for an unknown phase, and for one that the mission does not fly.
Phase read_flown_phase(const TomlTable& entry, const PerPhase<double>& duration_s);

/// Reads the time [s] at `key`: seconds, or percent ("40 %") of `duration_s`. Throws InputError for anything else.
double read_time_s(const TomlTable& entry, std::string_view key, double duration_s);

}  // namespace flightwatt::mission
