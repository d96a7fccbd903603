#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"
#include "flight/selected_track.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// What the current sensor reads on the ground with the motor off.
struct IdleCurrent {
    double mean_a = 0.0;
    double sd_a = 0.0;  ///< standard deviation of the samples: the sensor's noise
    std::size_t samples = 0;
};

/// A time without a power sample, longer than three usual intervals.
struct PowerGap {
    double start_s = 0.0;
    double duration_s = 0.0;
};

/// An integral that is further away from the on-board counter is a fault.
inline constexpr double max_closure_percent = 10.0;

/// How far a power record can be trusted.
struct PowerReport {
    CurrentOrigin origin = CurrentOrigin::unknown;
    std::optional<IdleCurrent> idle;
    std::optional<double> energy_closure_percent;  ///< in flight: integral of power over counter, less 100 %
    std::optional<double> charge_closure_percent;  ///< the same of current and the charge counter
    double energy_rounding_percent = 0.0;          ///< what the counter's rounding may add to its closure
    double charge_rounding_percent = 0.0;
    std::vector<PowerGap> gaps;             ///< within the sorties
    std::vector<std::string> power_faults;  ///< what cannot be: such a record is not fitted
    std::vector<std::string> warnings;      ///< what is doubtful, though it can be
};

/// Checks a power record. The closure is over the sorties, lift-off to touchdown (that of a phase stands in its
/// statistics); the idle current over the rests with the motor off. Power faults are: more than 5 A in a tenth of the
/// samples at rest with the motor off; power that is not voltage times current (more than 10 % apart, median, above
/// 1 W); a counter that runs back in flight by more than 5 % of what it counted; an integral more than 10 % away from
/// the counter; power that is negative on average, or does not change at all, in flight. The warnings and their
/// thresholds stand in docs/methods.md.
PowerReport check_power_record(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// The faults as the reason why a flight is not fitted, and how to overrule that.
std::string describe_power_faults(const std::vector<std::string>& power_faults);

/// Takes the idle current out of current and power (with the voltage measured at the same time; without one,
/// the idle power out of the power). Counters stay as they are. Does nothing where no idle current is known.
void correct_idle_offset(FlightSeries& series, const std::optional<IdleCurrent>& idle);

}  // namespace flightwatt::flight
