#pragma once

#include "base/diagnostic.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The reading of the current sensor on the ground with the motor off.
struct IdleCurrent {
    double mean_a = 0.0;
    double sd_a = 0.0;  ///< standard deviation of the samples: the sensor's noise
    std::size_t samples = 0;
};

/// An interval of more than gap_threshold_s() without a sample, within a sortie or at its edge.
struct SampleGap {
    double start_s = 0.0;
    double duration_s = 0.0;
    std::size_t end = 0;     ///< index of the sample after it
    bool is_within = false;  ///< both ends are within the sortie
};

/// The quality of a power record.
struct PowerReport {
    CurrentOrigin origin = CurrentOrigin::unknown;
    std::optional<IdleCurrent> idle;
    std::optional<double>
        energy_closure_percent;  ///< integral of the power in flight over the energy counter, less 100 %
    std::optional<double> charge_closure_percent;  ///< integral of the current over the charge counter, less 100 %
    std::vector<SampleGap> gaps;                   ///< gaps within the sorties
    std::vector<std::string> power_faults;         ///< impossible values: the record is not used in fits
    Diagnostics warnings;                          ///< suspect, but possible values
};

}  // namespace flightwatt::flight
