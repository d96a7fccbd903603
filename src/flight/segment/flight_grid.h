#pragma once

#include "flight/checks/runs.h"
#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/flight_series.h"
#include "flight/segment/motor_record.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The tracks of a flight with a constant time step and without spikes of single samples, for the segmentation.
struct ResampledFlight {
    double start_s = 0.0;
    double step_s = segmentation_step_s;
    std::vector<double> altitude_m;
    std::vector<double> throttle_percent;  ///< empty if unknown
    std::vector<double> motor_percent;     ///< see MotorRecord; empty if unknown
    double min_motor_percent = 0.0;
    std::vector<double> ground_speed_m_per_s;  ///< empty if unknown; 0 where nothing shows motion
    std::vector<bool> has_altitude;            ///< false in long gaps of the altitude and beyond its ends
    std::vector<IndexSpan> pieces;             ///< parts between jumps of the altitude; together the whole grid
    std::vector<IndexSpan> hovers;             ///< see find_hovers
    Track jumps_in_flight;                     ///< jumps of the altitude [m] while the motor runs
    Track detector;                            ///< the autopilot's land detector: the track "landed"
    MotorIndicator motor_indicator = MotorIndicator::unknown;
    std::string motor_evidence;           ///< see MotorRecord
    std::vector<std::string> warnings;    ///< about removed and substituted data
    std::string unusable;                 ///< see CleanedAltitude
    std::vector<double> altitude_time_s;  ///< times of the samples that are used

    std::size_t size() const { return altitude_m.size(); }
    double time_s(std::size_t index) const { return start_s + step_s * static_cast<double>(index); }
    /// Returns the times of a span.
    std::vector<double> times_s(IndexSpan span) const;
    /// Returns the number of steps in `duration_s`.
    std::size_t steps(double duration_s) const { return static_cast<std::size_t>(duration_s / step_s); }
};

/// Longest interval between two samples of an altitude or a speed in which it counts as known [s].
inline constexpr double long_gap_s = 10.0;

/// Returns the interval [s] between the samples around a time, outside of the samples from the nearest one; infinite
/// without samples.
double interval_around_s(const std::vector<double>& sample_s, double time_s);

/// Resamples the altitude, motor and speed over the time of the power samples, up to one interval after those of a slow
/// power, or without power of the altitude. A receiver's altitude without a fix is not used. Throws InputError if the
/// flight has no altitude.
ResampledFlight make_grid(const FlightData& data);

/// Finds the spans in which the aircraft is at rest: see SegmentationOptions. If motor and speed are known, the
/// altitude need not be constant, as that of a receiver wanders, but may not descend; and a rest lasts until the motor
/// runs or the aircraft is fast.
std::vector<IndexSpan> find_rests(const ResampledFlight& grid, const SegmentationOptions& options);

/// Returns the maximum of motor_percent of an idling motor.
double idle_motor_percent(const ResampledFlight& grid, const SegmentationOptions& options);
/// Returns the minimum that the maximum of motor_percent has in a flight.
double flight_motor_percent(const ResampledFlight& grid, const SegmentationOptions& options);

}  // namespace flightwatt::flight
