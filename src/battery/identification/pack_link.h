#pragma once

#include "battery/identification/aligned_fit.h"

#include <cstddef>
#include <optional>
#include <span>

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

}  // namespace flightwatt::battery
