#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "mission/mission_file.h"
#include "mission/schedule.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

/// The tables of a mission file (docs/missions.md). All throw InputError for keys that are unknown, missing or out of
/// range.
namespace flightwatt::mission {

/// The file that a key names, relative to the mission file. Throws InputError at the key where it cannot be read.
std::filesystem::path file_of(const TomlTable& table, std::string_view key);

/// The mission's [packs] without `home`, which read_cruise_path reads; none without one.
std::optional<Packs> read_packs(const TomlTable& mission);

/// Changes the mechanical model to the mission's payload_kg, if it is stated: its phases in proportion to the physical
/// model's power, or, where the flights do not determine that, by their takeoff_mass_kg and an assumption, with a note
/// and a wider spread. Throws InputError where neither is known.
void apply_payload(const TomlTable& mission_table, MissionSetup& mission);

/// Sets the level of the cruise to that of the mission's airspeed_m_per_s by the physical model; leaves it where none
/// is stated. Throws InputError for a model without one, and far beyond what its flights flew.
void apply_airspeed(const TomlTable& mission_table, MissionSetup& mission);

/// Reads [path] and [wind] of a mission file (docs/missions.md), where there is a path, and makes the cruise of it: its
/// path, duration and level. `reading` may change how much of it is flown. Throws InputError for a key missing, unknown
/// or out of range, a path that cannot be flown, and a model without a physical part.
void read_cruise_path(const TomlTable& mission_table, const MissionReadOptions& reading, MissionSetup& mission);

/// The `utility` of a component.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

/// The mission's [plan], all of which may be absent.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

/// The mission's [policy]; none for a static one. `decide_every_s` stays 0 where it is not given.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

/// One entry of a schedule as it was written.
struct ScheduleEntry {
    std::optional<Phase> phase;  ///< none: any phase (only with otherwise)
    bool otherwise = false;      ///< what no explicit entry covers
    bool whole_phase = false;    ///< explicit, and without from, to or middle
    double start_s = 0.0;        ///< since the phase began; not read if otherwise
    double end_s = 0.0;
    compute::Configuration run;
    Location where;
};

/// Reads the [[schedule]] of a mission file (docs/missions.md). Throws InputError for an unknown phase, component,
/// parameter or key, a parameter missing or out of its profile's range, and a segment that is empty or not within
/// its phase.
std::vector<ScheduleEntry> read_schedule(const TomlTable& mission, const compute::ComputeModel& compute,
                                         const PerPhase<double>& duration_s);

/// Segments in order that cover each instant of each phase exactly once: the explicit entries, then for what
/// they leave of a phase its `otherwise`, then the mission's. `entries` is not empty. Throws InputError for
/// two explicit entries at the same time, a gap that no `otherwise` fills, or an `otherwise` that is there
/// twice or has nothing left to cover.
Schedule resolve_schedule(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s);

/// The segments of the explicit entries, in order: the fixed part of a schedule to be planned. Throws
/// InputError for two entries at the same time, and for `otherwise`, which would leave nothing to plan.
Schedule resolve_fixed_segments(const std::vector<ScheduleEntry>& entries, const PerPhase<double>& duration_s);

/// The phase at `phase`. Throws InputError for one that there is not, or that the mission does not fly.
Phase read_flown_phase(const TomlTable& entry, const PerPhase<double>& duration_s);

/// The time at `key`: seconds, or percent ("40 %") of `duration_s`. Throws InputError for anything else.
double read_time_s(const TomlTable& entry, std::string_view key, double duration_s);

}  // namespace flightwatt::mission
