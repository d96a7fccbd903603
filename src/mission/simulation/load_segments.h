#pragma once

#include "battery/discharge.h"
#include "mission/disturbance.h"
#include "mission/mission.h"

#include <memory>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A battery that ends this near to the end of its mission has lasted.
inline constexpr double end_tolerance_s = 1e-6;

/// What a mission demands while one configuration runs: mechanical power, smooth but for the jumps between the pieces
/// of a path or of a measured flight, and constant computing. Times are those of the mission.
struct LoadSegment : TimeInterval {
    Phase phase = Phase::takeoff;
    double phase_start_s = 0.0;
    std::optional<mechanical::FourierModel> mechanical;  ///< in the phase's own time
    std::shared_ptr<const path::PiecewisePower> pieces;  ///< instead: in the phase's own time too
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;  ///< [points] that the battery loses at once as this starts
};

/// What the schedules of a mission demand, as far as it does not depend on the schedule. Refers to the mission.
struct MissionLoad {
    const MissionSetup& mission;
    MissionTimeline timeline;
    /// Of the phases that are flown, in their own time; none without a mechanical model.
    PerPhase<std::optional<mechanical::FourierModel>> mechanical;
    PerPhase<std::shared_ptr<const path::PiecewisePower>> pieces =
        {};  ///< of a path or a measured flight, instead of a curve
};

MissionLoad make_mission_load(const MissionSetup& mission);
/// Of pieces it may hold jumps, which split_at_jumps parts.
LoadSegment load_segment(const MissionLoad& load, const ScheduleSegment& scheduled);

/// A segment, parted where its pieces meet: each of one constant power. Others are one part.
std::vector<LoadSegment> split_at_jumps(const LoadSegment& segment);

/// The load of a schedule in smooth parts, in order and without gaps: each starts exactly where the one before ends.
std::vector<LoadSegment> load_segments(const MissionSetup& mission, const Schedule& schedule);

/// The segments, which are smooth parts, cut where a disturbance starts or ends and changed in between.
std::vector<LoadSegment> disturbed(const std::vector<LoadSegment>& segments, const Disturbances& disturbances);

double mechanical_w(const LoadSegment& segment, double time_s);
double power_w(const LoadSegment& segment, double time_s);

/// Bounds of a segment's power: no harmonic is greater than its amplitude.
struct PowerBounds {
    double low_w = 0.0;
    double high_w = 0.0;
};
PowerBounds bounds_of(const LoadSegment& segment);

/// [s] Steps over which a segment's power is nearly a parabola, for fast_discharge.
double quick_step_s(const LoadSegment& segment);

/// Energies [J] demanded from the segment's start to `time_s`, a time within it.
double mechanical_energy_j(const LoadSegment& segment, double time_s);
double compute_energy_j(const LoadSegment& segment, double time_s);

/// The battery after the charge that it loses at once as a segment starts.
battery::Discharge apply_charge_drop(battery::Discharge state, const LoadSegment& segment);

/// The battery after a segment, for flights that are flown by the thousand: an integral of the power where the source
/// is constant and nothing but its charge can end it, fast_discharge of a Thevenin circuit that is not charged, and
/// else Runge-Kutta with steps of a second. A battery that has ended, or cannot deliver, stays as it is.
battery::Discharge advance_segment(const battery::Battery& battery, double cutoff_voltage_v, const LoadSegment& segment,
                                   battery::Discharge state);

/// A time, and the power then.
struct PowerAt {
    double time_s = 0.0;
    double power_w = 0.0;
};

/// The least of a curve within a time, to 1e-6 W and better. Where the amplitudes alone show that it is `enough_w` or
/// more, a bound below the least, at the start.
PowerAt min_power_w(const mechanical::FourierModel& curve, const TimeInterval& within, double enough_w = 0.0);

/// Throws InputError where a mission asks for power below 0, with phase, time and power: it would charge the battery,
/// and nobody said that something aboard does (may_charge).
void refuse_charging(const MissionSetup& mission, const std::vector<LoadSegment>& segments);

}  // namespace flightwatt::mission
