#pragma once

#include "battery/identification/aligned_fit.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// Why a record is taken to be flown on the pack of the one before it.
struct PackLink {
    std::size_t earlier = 0;
    double charge_ah = 0.0;          ///< drawn by the earlier one
    double error_ah = 0.0;           ///< of that: 2 % and 5 mAh, what the counter and the time after the log may hide
    double pause_s = 0.0;            ///< from the end of the earlier record
    bool counter_continues = false;  ///< the autopilot counted on: it was not without a pack in between
};

/// Which of `known` the pack of `later` was flown in last, for all that clocks, counters and resting voltages say. A
/// log does not name its pack: it is taken for the pack of the last record before it that ended at most six hours
/// earlier, if it rests lower than that one did, by more than half of what the curve fell meanwhile, and by no more
/// than that and what relaxation may take. A counter that begins above 0, but not where the earlier one ended, says no.
/// Clocks are the logs', else those in the names of both ("20_07_10__06_53_03"). None where that is not known.
std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit);

/// What a log says of its packs: all channels as long as `time_s`, counter and throttle empty where not logged.
struct PackRecord {
    std::vector<double> time_s = {};
    std::vector<double> voltage_v = {};
    std::vector<double> current_a = {};
    std::vector<double> counter_ah = {};
    std::vector<double> throttle_percent = {};
};

/// [A] A current below is rest, with electronics on: 15 % of the greatest, and at least 0.2 A.
inline double load_threshold_a(double max_a) { return std::max(0.2, 0.15 * max_a); }

/// [Ah] Charge drawn since the first sample, by the trapezoids of the current.
std::vector<double> integrated_charge_ah(const std::vector<double>& time_s, const std::vector<double>& current_a);

/// The record cut where a pack was changed at rest, after a load and before another: where the voltage steps up by 3 %
/// (0.12 V a cell) between the medians of five samples, later than 5 s after the load, when what a pack recovers comes
/// slowly; or by 1 % later than 15 s after it, or where the charge counter begins anew. A counter that begins anew
/// without that (the autopilot did) goes on from where it was, by the current's integral. `notes` says both.
std::vector<PackRecord> split_at_pack_changes(PackRecord record, std::vector<std::string>& notes);

}  // namespace flightwatt::battery
