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

/// Demand of a mission while one configuration runs: smooth mechanical and constant computing power, in mission time.
struct LoadSegment : TimeInterval {
    Phase phase = Phase::takeoff;
    double phase_start_s = 0.0;
    std::optional<mechanical::FourierModel> mechanical;  ///< in the phase's own time
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;  ///< [points] that the battery loses at once as this starts
};

/// Demand of a mission that does not depend on its schedule. Refers to the mission.
struct MissionLoad {
    const MissionSetup& mission;
    MissionTimeline timeline;
    /// Of the phases that are flown, in their own time; none without a mechanical model.
    PerPhase<std::optional<mechanical::FourierModel>> mechanical;
    PerPhase<std::shared_ptr<const path::PiecewisePower>> pieces =
        {};  ///< of a path or a measured flight, instead of a curve
};

MissionLoad make_mission_load(const MissionSetup& mission);

/// The load of a part of a schedule: one segment, or one of constant power for each piece that a path or a measured
/// flight has in that time. In order and without gaps: each starts exactly where the one before ends.
std::vector<LoadSegment> load_segments(const MissionLoad& load, const ScheduleSegment& scheduled);
/// The same of a whole schedule.
std::vector<LoadSegment> load_segments(const MissionSetup& mission, const Schedule& schedule);

/// The segments, cut where a disturbance starts or ends and changed in between; and cut at `times_s`.
std::vector<LoadSegment> disturbed(std::vector<LoadSegment> segments, const Disturbances& disturbances,
                                   const std::vector<double>& times_s = {});

double mechanical_w(const LoadSegment& segment, double time_s);
double power_w(const LoadSegment& segment, double time_s);

/// Bounds of a segment's power: no harmonic is greater than its amplitude.
Interval bounds_of(const LoadSegment& segment);

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

/// Throws InputError where a mission asks for power below 0 by more than fits that touch 0, with phase, time and power:
/// it would charge the battery, without may_charge.
void refuse_charging(const MissionSetup& mission, const std::vector<LoadSegment>& segments);

}  // namespace flightwatt::mission
