#pragma once

#include "battery/battery.h"
#include "battery/identification/circuit_errors.h"
#include "battery/identification/circuit_fit.h"
#include "battery/identification/discharge_record.h"
#include "battery/identification/open_circuit.h"
#include "battery/identification/pack_changes.h"
#include "battery/identification/state_of_health.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

struct IdentificationOptions {
    std::optional<double> capacity_ah;
    std::optional<int> cells;  ///< default: from the highest resting voltage
    std::string name = "identified";
    bool with_capacities = false;  ///< of each flight too, in the same least squares as its resistance
    bool link_packs =
        true;  ///< take a flight for one on the pack of the flight before it, where all agrees (pack_changes.h)
};

/// One flight in the fit.
struct IdentifiedFlight {
    std::string flight;
    double resting_voltage_v = 0.0;
    double initial_depletion_ah = 0.0;  ///< missing from the full pack when it began
    Interval initial_charge_interval_ah;
    double drawn_ah = 0.0;
    std::string same_pack_as;      ///< assumed to be flown on the pack that this flight left; empty: none is known
    std::optional<PackLink> link;  ///< why; `earlier` is its place among the flights
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< with_capacities, where the flight tells it
    std::optional<double> air_temperature_c;
    std::size_t samples = 0;
    std::size_t unused = 0;  ///< with a current that the motor did not draw
    double voltage_rms_v = 0.0;
};

/// How a flight's voltage is predicted by the others. Under load is from the first load on.
struct LeaveOneOutCheck {
    std::string flight;
    double voltage_rms_v = 0.0;      ///< of all samples, from what is known before take-off
    double load_rms_v = 0.0;         ///< of those under load
    double initial_charge_ah = 0.0;  ///< missing from the full pack, as the others and its rest before take-off tell it
    std::string pack_of;             ///< by which flight's pack; empty: by its resting voltage
    double best_offset_load_rms_v =
        0.0;                      ///< with the initial charge that fits its voltage best, which is known afterwards
    double best_offset_ah = 0.0;  ///< that initial charge
    double extrapolated_percent = 0.0;  ///< of its samples: with more charge drawn than in any other flight
};

struct BatteryIdentification {
    Battery battery;
    CircuitFit fit;
    CircuitErrors errors;
    Capacity capacity;
    int cells = 0;
    bool cells_are_given = false;
    double curve_start_depletion_ah = 0.0;    ///< from the full pack, where the curve begins
    double observed_min_soc_percent = 0.0;    ///< state of charge; below, the curve is the LiPo chart's
    double observed_max_soc_percent = 100.0;  ///< above, likewise
    std::vector<IdentifiedFlight> flights;
    std::optional<ResistanceTrend> trend;  ///< over the flights in the order of their clocks, else as given
};

/// [V] of the fullest flight.
double highest_resting_v(const BatteryIdentification& identified);

/// Identifies the Thévenin circuit of a battery from flights. What was missing from the pack is a parameter of each
/// flight in the same least squares; flights on one pack are chained (aligned_fit.h, pack_changes.h). Capacity, and what
/// was missing from the fullest flight, are laid onto the LiPo chart (chart_match.h): a fullest flight that rests as a
/// full pack may counts as full. The battery holds the flights' own estimate of the capacity even if another is given.
/// Throws NoResultError where the flights determine no such circuit, and as estimate_capacity and
/// require_possible_cells do.
BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options);

/// At every sample of a record; the state of charge may fall below 0 where the capacity is too small.
struct PredictedVoltage {
    std::vector<double> soc_percent;
    std::vector<double> voltage_v;  ///< terminal
};

/// Predicts a record with a Thévenin battery, from its current and the charge that was missing when it began.
PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record, double initial_charge_ah);

/// Of more records than this, groups are left out together (folds_of).
inline constexpr std::size_t max_battery_folds = 20;

/// Identifies the battery without each record in turn (or each of `max_folds` groups) and predicts that record from its
/// current, and from what is known before take-off: whose pack it is, or else its resting voltage; and with its initial
/// charge free, to tell how much of the error is that charge's. Empty for a single record. `progress` is told how many
/// of how many folds are done.
std::vector<LeaveOneOutCheck> leave_one_out(std::span<const DischargeRecord> records,
                                            const IdentificationOptions& options,
                                            const std::function<void(std::size_t, std::size_t)>& progress = {},
                                            std::size_t max_folds = max_battery_folds);

}  // namespace flightwatt::battery
