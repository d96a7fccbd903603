#pragma once

#include "base/error.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// One entry of a schedule as it was written.
struct ScheduleEntry {
    std::optional<flight::Phase> phase;  ///< none: any phase (only with otherwise)
    bool otherwise = false;              ///< what no explicit entry covers
    bool whole_phase = false;            ///< explicit, and without from, to or middle
    double from_s = 0.0;                 ///< since the phase began; not read if otherwise
    double to_s = 0.0;
    compute::Configuration run;
    Location where;
};

/// A part of a phase in which one configuration runs.
struct Stretch {
    flight::Phase phase = flight::Phase::takeoff;
    double from_s = 0.0;  ///< since the phase began
    double to_s = 0.0;
    compute::Configuration run;
    bool operator==(const Stretch&) const = default;
};

/// Ends nearer than this are one: percentages of a phase meet seconds only up to rounding.
constexpr double same_time_tolerance_s(double phase_duration_s) {
    return 1e-9 * (phase_duration_s > 1.0 ? phase_duration_s : 1.0);
}

/// Stretches in order that cover each instant of each phase exactly once: the explicit entries, then for what
/// is left of a phase its `otherwise`, then the mission's. `entries` is
/// not empty. Throws InputError for two explicit entries at the same time, a gap that no
/// `otherwise` fills, or an `otherwise` that is there twice or has nothing left to cover.
std::vector<Stretch> lay_out(const std::vector<ScheduleEntry>& entries,
                             const flight::PerPhase<double>& duration_s);

/// The stretches of the explicit entries alone, in order: what is fixed of a schedule yet to be planned.
/// Throws InputError for two entries at the same time, and for `otherwise`, which would leave nothing to
/// plan.
std::vector<Stretch> lay_out_fixed(const std::vector<ScheduleEntry>& entries,
                                   const flight::PerPhase<double>& duration_s);

}  // namespace flightwatt::mission
