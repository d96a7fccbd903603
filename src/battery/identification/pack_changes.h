#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// The channels of a log, all as long as `time_s`; counter and throttle are empty where not logged.
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

/// The record split where a pack was changed at rest between two loads, while the aircraft `stands` at that time [s]:
/// where the voltage rises by 3 % between medians of five samples, later than 5 s after the load; or by 1 % later than
/// 15 s after it, or at a reset of the charge counter; or where it falls by 3 %, or by 1 % at such a reset. A counter
/// reset without a step (by the autopilot) is corrected with the current's integral. `notes` reports both.
std::vector<PackRecord> split_at_pack_changes(PackRecord record, std::vector<std::string>& notes,
                                              const std::function<bool(double)>& stands);

}  // namespace flightwatt::battery
