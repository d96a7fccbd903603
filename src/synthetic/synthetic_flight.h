#pragma once

#include "flight/flight_phases.h"
#include "mechanical/mechanical_model.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::synthetic {

/// A synthetic flight: waits on the ground, runs its motor up, takes off, climbs into a circle, descends in circles,
/// lands and waits.
struct SyntheticFlight {
    double motor_run_up_s = 30.0;  ///< start of the motor test on the ground
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
    std::vector<double> dives_s;                   ///< start in cruise, down to a third of the height and up again
    double low_stage_s = 0.0;                      ///< duration at low_stage_fraction before the landing
    double landing_step_s = 0.0;                   ///< duration at landing_step_fraction within the landing
    double estimator_fix_s = 0.0;                  ///< before, the estimator is at 0; then it rises to the altitude
    bool power_burst_after_landing = false;        ///< without throttle
    bool throttle_burst_before_touchdown = false;  ///< at the end of a glide
    /// Power [W] of a phase at tau in [0, 1] of it.
    std::function<double(flight::Phase phase, double tau)> power_w;

    double motor_run_up_end_s() const { return motor_run_up_s + motor_run_up_length_s; }
    double start_s(flight::Phase phase) const;
    double end_s(flight::Phase phase) const { return start_s(phase) + duration_s[phase]; }
    double log_end_s() const { return end_s(flight::Phase::landing) + ground_after_s; }
};

/// Of the height, before and within the landing.
inline constexpr double low_stage_fraction = 0.6;
inline constexpr double landing_step_fraction = 0.55;

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
    double estimated_altitude_m = 0.0;  ///< of the estimator, without noise
};

SyntheticState state_at(const SyntheticFlight& flight, double time_s);

/// Consecutive flights of a log (their times are the log's), and its begin and end.
struct SyntheticScenario {
    std::vector<SyntheticFlight> flights;
    double begin_s = 8.0;  ///< after the start of the server's clock
    double end_s = 0.0;
};

/// Anomalies of real logs that the segmentation must handle, by their names on the command line.
const std::vector<std::string>& anomaly_names();

/// A log of a flight with an anomaly; without one for any other name.
SyntheticScenario make_scenario(SyntheticFlight flight, std::string_view anomaly = "");

/// Half width [W] of the band of flights at tau in [0, 1] of a phase, by the paper's description of the grey bands of
/// Fig. 2: take-off varies mostly at its beginning, cruise little, landing most at its beginning and end.
double band_w(flight::Phase phase, double tau);

struct SpreadOptions {
    double band_scale = 1.0;        ///< standard deviation between flights, in half widths of the band
    double duration_spread = 0.06;  ///< uniform within +- this fraction of the model's duration
};

/// Draws `count` flights about a model. Each phase is a Fourier series of the model's frequency (as in Eqs. 5-7) in the
/// band, with its own duration. Flights are drawn in opposite pairs (with an odd number, one is the model), so that
/// their mean is the model. The same seed gives the same flights.
std::vector<flight::PerPhase<mechanical::PhaseModel>> draw_flights(const mechanical::MechanicalModel& model,
                                                                   std::size_t count, std::uint64_t seed,
                                                                   const SpreadOptions& options = {});

}  // namespace flightwatt::synthetic
