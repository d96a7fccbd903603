#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace flightwatt::battery {

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
