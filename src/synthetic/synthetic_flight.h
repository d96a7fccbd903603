#pragma once

#include "flight/flight_phases.h"

#include <functional>
#include <vector>

namespace flightwatt::synthetic {

/// A synthetic flight: what truly happens, as functions of time. It waits on the ground, runs its motor up,
/// takes off, climbs into a circle, descends in circles, lands and waits.
struct SyntheticFlight {
    double motor_run_up_s = 30.0;  ///< when the motor is tried on the ground
    double motor_run_up_length_s = 4.0;
    double motor_run_up_power_w = 35.0;
    double lift_off_s = 60.0;
    flight::PerPhase<double> duration_s{{28.0, 600.0, 60.0}};
    double ground_after_s = 30.0;  ///< from touchdown to the end of the log
    double ground_altitude_m = 15.0;
    double height_m = 90.0;
    double circle_radius_m = 80.0;
    double airspeed_m_per_s = 13.0;
    double wind_east_m_per_s = 2.0;
    double wind_north_m_per_s = -1.0;
    std::vector<double> dives_s;                   ///< in cruise: down to a third of the height and up again
    double low_stage_s = 0.0;                      ///< so long before the landing it works at low_stage_fraction
    double landing_step_s = 0.0;                   ///< so long within the landing it circles at landing_step_fraction
    double estimator_fix_s = 0.0;                  ///< until then the estimator reads 0, then it climbs to the truth
    bool power_burst_after_landing = false;        ///< without throttle
    bool throttle_burst_before_touchdown = false;  ///< at the end of a glide with the motor off
    /// Power [W] of a phase at tau in [0, 1] of it.
    std::function<double(flight::Phase phase, double tau)> power_w;

    double motor_run_up_end_s() const { return motor_run_up_s + motor_run_up_length_s; }
    double start_s(flight::Phase phase) const;
    double end_s(flight::Phase phase) const { return start_s(phase) + duration_s[phase]; }
    double log_end_s() const { return end_s(flight::Phase::landing) + ground_after_s; }
};

/// Of the height: where it works before the landing, and where it circles within it.
inline constexpr double low_stage_fraction = 0.6;
inline constexpr double landing_step_fraction = 0.55;

/// What the aircraft does at one moment.
struct SyntheticState {
    double altitude_m = 0.0;
    double climb_m_per_s = 0.0;
    double east_m = 0.0;
    double north_m = 0.0;
    double course_rad = 0.0;  ///< clockwise from north
    double ground_speed_m_per_s = 0.0;
    double airspeed_m_per_s = 0.0;
    double wind_east_m_per_s = 0.0;
    double wind_north_m_per_s = 0.0;
    double power_w = 0.0;
    double throttle_percent = 0.0;
    int mode = 0;
    int block = 0;
    bool airborne = false;
    double estimated_altitude_m = 0.0;  ///< what the estimator makes of it, without noise
};

SyntheticState state_at(const SyntheticFlight& flight, double time_s);

/// What a log holds: flights one after the other (their times are the log's), and where it begins and ends.
struct SyntheticScenario {
    std::vector<SyntheticFlight> flights;
    double begin_s = 8.0;  ///< the server's clock starts before the first message comes in
    double end_s = 0.0;
};

/// One flight from ground to ground.
SyntheticScenario plain_scenario(const SyntheticFlight& flight);

/// Things that real logs do and that must not fool the segmentation.
enum class LogAnomaly {
    none,
    estimator_starts_at_zero,
    dives_in_cruise,
    run_up,
    power_burst_after_landing,
    throttle_burst_before_touchdown,
    two_sorties,
    begins_in_the_air,
    ends_in_the_air,
    landing_in_steps,
    low_survey_stage,
};

/// All but none, with their names on the command line.
const std::vector<std::pair<std::string, LogAnomaly>>& anomaly_names();

/// The scenario of a flight with a hazard.
SyntheticScenario scenario_with_anomaly(SyntheticFlight flight, LogAnomaly hazard);

}  // namespace flightwatt::synthetic
