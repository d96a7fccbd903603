#pragma once

#include "mechanical/mechanical_model.h"

namespace flightwatt::mission {

/// A time within one phase, in seconds since the phase began.
struct PhaseSegment {
    flight::Phase phase = flight::Phase::takeoff;
    double start_s = 0.0;
    double end_s = 0.0;
    bool operator==(const PhaseSegment&) const = default;
    double duration_s() const { return end_s - start_s; }
};

/// When each phase is flown, in seconds since the mission began; a phase that is not flown starts as it ends.
struct MissionTimeline {
    flight::PerPhase<double> start_s;
    flight::PerPhase<double> end_s;
    double duration_s = 0.0;  ///< of the whole mission
};

MissionTimeline timeline_of(const flight::PerPhase<double>& duration_s);

/// Times of a phase nearer than this are one: percentages of a phase meet seconds only up to rounding.
constexpr double same_time_tolerance_s(double phase_duration_s) {
    return 1e-9 * (phase_duration_s > 1.0 ? phase_duration_s : 1.0);
}

/// Where a time of the mission lies when its phases take other durations: at the same part of the same phase.
double rescale_to_flown_durations_s(double time_s, const flight::PerPhase<double>& planned_s,
                                    const flight::PerPhase<double>& flown_s);

}  // namespace flightwatt::mission
