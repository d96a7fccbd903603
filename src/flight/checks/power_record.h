#pragma once

#include "flight/checks/runs.h"
#include "flight/flight_phases.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// What the power's sensor and counters say, on the clock of the power samples; empty where not logged.
struct PowerRecord {
    std::vector<double> time_s;
    std::vector<double> power_w;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    std::vector<double> charge_ah;
    std::vector<double> energy_wh;
    double charge_resolution_ah = 0.0;  ///< the decimal place that the counter is rounded to
    double energy_resolution_wh = 0.0;
    std::vector<double> throttle_percent;
    std::vector<double> altitude_m;
    std::vector<double> altitude_time_s;  ///< the altitude's own clock
    bool is_sum_of_circuits = false;      ///< with voltages of their own
    std::string power_source;             ///< "ENERGY.power"
    std::vector<SampleRange> in_flight;   ///< the samples of each sortie
    double energy_j = 0.0;                ///< in flight
    double duration_s = 0.0;
};

template <typename Visit>
void for_each_in_flight(const PowerRecord& record, Visit&& visit) {
    for (const auto& [first, last] : record.in_flight)
        for (auto i = first; i < last; ++i) visit(i);
}

PowerRecord make_power_record(const SelectedTracks& tracks, const FlightPhases& phases);

/// Indices of the power samples at rest on the ground with the motor off; where no throttle tells that of the motor, at
/// rest outside of the sorties.
std::vector<std::size_t> resting_samples(const PowerRecord& record, const std::vector<TimeInterval>& rests,
                                         const SegmentationOptions& options);

/// What the rules for samples of a power record found: faults exclude a flight from fits, warnings do not.
struct SampleFindings {
    std::vector<std::string> faults;
    std::vector<std::string> warnings;
};

/// Applies the table of rules in power_record.cpp. `resting`: the samples at rest with the motor off, in order.
SampleFindings apply_sample_rules(const PowerRecord& record, const std::vector<std::size_t>& resting);

}  // namespace flightwatt::flight
