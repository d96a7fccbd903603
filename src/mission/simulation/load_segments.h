#pragma once

#include "mission/disturbance.h"
#include "mission/mission.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// What a mission demands from one jump of power to the next: smooth mechanical power and constant computing.
/// Times are those of the mission.
struct LoadSegment {
    flight::Phase phase = flight::Phase::takeoff;
    double phase_start_s = 0.0;
    double start_s = 0.0;
    double end_s = 0.0;
    std::optional<mechanical::FourierModel> mechanical;  ///< in the phase's own time
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;  ///< [points] that the battery loses at once as this starts
};

/// The load of a schedule, in order and without gaps: each segment starts exactly where the one before ends.
std::vector<LoadSegment> load_segments(const MissionSetup& mission,
                                       const std::vector<ScheduleSegment>& schedule);

/// The segments, cut where a disturbance starts or ends and changed in between. Without mechanical power
/// there is none to disturb.
std::vector<LoadSegment> disturbed(const std::vector<LoadSegment>& segments,
                                   const std::vector<Disturbance>& disturbances);

double mechanical_w(const LoadSegment& segment, double time_s);
double power_w(const LoadSegment& segment, double time_s);

/// Energies [J] demanded from the segment's start to `time_s`, a time within it.
double mechanical_energy_j(const LoadSegment& segment, double time_s);
double compute_energy_j(const LoadSegment& segment, double time_s);

}  // namespace flightwatt::mission
