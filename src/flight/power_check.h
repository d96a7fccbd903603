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

/// A time without a sample of more than gap_threshold_s(), which a sortie touches or holds as a whole.
struct SampleGap {
    double start_s = 0.0;
    double duration_s = 0.0;
    std::size_t end = 0;  ///< the sample after it
    bool is_within = false;
};

/// How far a power record can be trusted.
struct PowerReport {
    CurrentOrigin origin = CurrentOrigin::unknown;
    std::optional<IdleCurrent> idle;
    std::optional<double> energy_closure_percent;  ///< in flight: integral of power over counter, less 100 %
    std::optional<double> charge_closure_percent;  ///< the same of current and the charge counter
    std::vector<SampleGap> gaps;                   ///< within the sorties
    std::vector<std::string> power_faults;         ///< what cannot be: such a record is not fitted
    std::vector<std::string> warnings;             ///< what is doubtful, though it can be
};

/// Checks a power record by the rules of docs/methods.md. The closure is over the sorties, lift-off to touchdown (that
/// of a phase stands in its statistics); the idle current over the rests with the motor off.
PowerReport check_power_record(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// The faults as the reason why a flight is not fitted, and how to overrule that.
std::string describe_power_faults(const std::vector<std::string>& power_faults);

/// Takes the idle current out of current and power (with the voltage measured at the same time; without one,
/// the idle power out of the power). Counters stay as they are. Does nothing where no idle current is known.
void correct_idle_offset(FlightSeries& series, const std::optional<IdleCurrent>& idle);

}  // namespace flightwatt::flight
