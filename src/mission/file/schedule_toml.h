#pragma once

#include "base/toml_reader.h"
#include "mission/file/schedule_entries.h"

#include <string_view>
#include <vector>

namespace flightwatt::mission {

/// Reads the [[schedule]] of a mission file. Each entry says when, and what runs then:
///
///     phase = "cruise"                           # the whole phase, or a segment of it:
///     from = 240                                 #   seconds since it began, or "40 %" of it; default: 0
///     to = "60 %"                                #   default: its end
///     middle = 120                               #   or so many seconds (or percent) in its middle
///     otherwise = true                           # with a phase: what is left of it; without: of the mission
///     run = { detection = { fps = 32 } }         # components with a value for each parameter; others are off
///
/// Throws InputError for an unknown phase, component, parameter or key, a parameter missing or out of its
/// profile's range, and a segment that is empty or not within its phase.
std::vector<ScheduleEntry> read_schedule(const TomlTable& mission, const compute::ComputeModel& compute,
                                         const flight::PerPhase<double>& duration_s);

/// The time at `key`: seconds, or percent ("40 %") of `duration_s`. Throws InputError for what is neither.
double read_time_s(const TomlTable& entry, std::string_view key, double duration_s);

}  // namespace flightwatt::mission
