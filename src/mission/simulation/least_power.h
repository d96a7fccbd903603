#pragma once

#include "mission/simulation/load_segments.h"

namespace flightwatt::mission {

/// A time, and the power then.
struct PowerAt {
    double time_s = 0.0;
    double power_w = 0.0;
};

/// From one time of a curve to another.
struct CurveInterval {
    double start_s = 0.0;
    double end_s = 0.0;
};

/// The least of a curve within a time, to 1e-6 W and better. Where the amplitudes alone show that it is `enough_w` or
/// more, a bound below the least, at the start.
PowerAt min_power_w(const mechanical::FourierModel& curve, const CurveInterval& within, double enough_w = 0.0);

/// Throws InputError where a mission asks for power below 0, with phase, time and power: it would charge the battery,
/// and nobody said that something aboard does (may_charge).
void refuse_charging(const MissionSetup& mission, const std::vector<LoadSegment>& segments);

}  // namespace flightwatt::mission
