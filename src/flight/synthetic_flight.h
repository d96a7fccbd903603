#pragma once

#include "flight/flight_phases.h"

#include <functional>
#include <string>

namespace flightwatt {

/// A made-up flight: what truly happens, as functions of time. It waits on the ground, runs its motor up,
/// takes off, climbs into a circle, descends in circles, lands and waits.
struct SyntheticFlight {
    double motor_run_up_s = 30.0;  ///< when the motor is tried on the ground
    double lift_off_s = 60.0;
    PerPhase<double> duration_s{{28.0, 600.0, 60.0}};
    double ground_after_s = 30.0;  ///< from touchdown to the end of the log
    double ground_altitude_m = 15.0;
    double height_m = 90.0;
    double circle_radius_m = 80.0;
    double airspeed_m_per_s = 13.0;
    double wind_east_m_per_s = 2.0;
    double wind_north_m_per_s = -1.0;
    /// Power [W] of a phase at tau in [0, 1] of it.
    std::function<double(Phase phase, double tau)> power_w;

    double start_s(Phase phase) const;
    double end_s(Phase phase) const { return start_s(phase) + duration_s[phase]; }
    double log_end_s() const { return end_s(Phase::landing) + ground_after_s; }
};

/// What the aircraft does at one moment.
struct SyntheticState {
    double altitude_m = 0.0;
    double climb_m_per_s = 0.0;
    double east_m = 0.0;
    double north_m = 0.0;
    double course_rad = 0.0;  ///< clockwise from north
    double ground_speed_m_per_s = 0.0;
    double power_w = 0.0;
    double throttle_percent = 0.0;
    int mode = 0;
    int block = 0;
    bool airborne = false;
};

SyntheticState state_at(const SyntheticFlight& flight, double time_s);

}  // namespace flightwatt
