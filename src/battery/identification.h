#pragma once

#include "battery/discharge_record.h"
#include "battery/identified_battery.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

struct IdentificationOptions {
    std::optional<double> capacity_ah;
    std::optional<int> cells;  ///< default: as the logs state, else from the highest resting voltage
    std::string name = "identified";
    bool with_capacities = false;  ///< of each flight too, in the same least squares as its resistance
};

/// Identifies the Thévenin circuit of a battery from flights, with the charge missing at the start of each
/// (circuit_problem.h). Capacity, and the charge missing from the fullest flight, come from
/// charts (chart_match.h); the flights' own estimate of the capacity is added even if another is given. Throws
/// NoResultError where the flights determine no such circuit, and as estimate_capacity and require_possible_cells.
BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options);

/// At every sample of a record; the state of charge may fall below 0 where the capacity is too small.
struct PredictedVoltage {
    std::vector<double> soc_percent;
    std::vector<double> voltage_v;  ///< terminal
};

/// Predicts a record with a Thévenin battery, from its current and the charge that was missing when it began. Its
/// resistance falls as the pack warms (CircuitFit::warming_per_j).
PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record, double initial_charge_ah,
                                 double warming_per_j = 0.0);

/// Of more records than this, groups are left out together (make_folds).
inline constexpr std::size_t max_battery_folds = 20;

/// Identifies the battery without each record in turn (or each of `max_folds` groups) and predicts that record from its
/// current and its resting voltage before take-off. Empty for a single record. `progress` gets the numbers of done and of all folds.
std::vector<LeaveOneOutCheck> leave_one_out(std::span<const DischargeRecord> records,
                                            const IdentificationOptions& options,
                                            const std::function<void(std::size_t, std::size_t)>& progress = {},
                                            std::size_t max_folds = max_battery_folds);

}  // namespace flightwatt::battery
