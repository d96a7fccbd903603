#pragma once

#include "flight/chosen_track.h"
#include "flight/flight_phases.h"
#include "flight/segmentation.h"

#include <cstddef>
#include <vector>

namespace flightwatt::flight {

/// The samples [first, last).
struct SampleRange {
    std::size_t first;
    std::size_t last;
};

/// What the power's sensor and counters say, on the clock of the power samples; empty where not logged.
struct PowerRecord {
    std::vector<double> time_s;
    std::vector<double> power_w;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    std::vector<double> charge_ah;
    std::vector<double> energy_wh;
    std::vector<double> throttle_percent;
    std::vector<double> altitude_m;
    std::vector<double> altitude_time_s;  ///< the altitude's own clock
    bool is_sum = false;                  ///< of several devices
    std::vector<SampleRange> flown;       ///< the samples of each sortie
};

PowerRecord record_of(const ChosenTracks& tracks, const FlightPhases& phases);

/// Indices of the power samples at rest on the ground with the motor off; where no throttle tells that of the motor, at
/// rest outside of the sorties.
std::vector<std::size_t> resting_samples(const PowerRecord& record, const std::vector<Rest>& rests,
                                         const SegmentationOptions& options);

}  // namespace flightwatt::flight
