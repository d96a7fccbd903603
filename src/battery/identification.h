#pragma once

#include "battery/battery.h"
#include "battery/identification/circuit_fit.h"
#include "battery/identification/discharge_record.h"
#include "battery/identification/open_circuit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::battery {

struct IdentificationOptions {
    std::optional<double> capacity_ah;
    std::optional<int> cells;  ///< default: from the highest resting voltage
    std::string name = "identified";
};

/// One flight in the fit.
struct IdentifiedFlight {
    std::string flight;
    double resting_voltage_v = 0.0;
    double initial_charge_ah = 0.0;  ///< missing from the fullest flight's, by the resting voltage
    double drawn_ah = 0.0;
    std::size_t samples = 0;
    std::size_t unused = 0;  ///< with a current that the motor did not draw
    double voltage_rms_v = 0.0;
};

/// How a flight's voltage is predicted by the others.
struct LeftOutCheck {
    std::string flight;
    double voltage_rms_v = 0.0;
    double beyond_percent = 0.0;  ///< of its samples: with more charge drawn than in any other flight
};

struct BatteryIdentification {
    Battery battery;
    CircuitFit fit;
    CircuitErrors errors;
    Capacity capacity;
    int cells = 0;
    double known_down_to_percent = 0.0;  ///< state of charge; below, the curve is the LiPo chart's
    std::vector<IdentifiedFlight> flights;
};

/// Identifies the Thévenin circuit of a battery from flights. The fullest flight, by its resting voltage, begins at
/// 100 %; the others' initial charge is where their resting voltage lies on the curve. The curve has as many equal
/// segments as Akaike's criterion prefers, counting samples by the autocorrelation of the residuals, and falls
/// throughout. Throws NoAnswerError where the flights determine no such circuit, and as capacity_of does.
BatteryIdentification identify_battery(std::span<const DischargeRecord> records, const IdentificationOptions& options);

/// At every sample of a record; the state of charge may fall below 0 where the capacity is too small.
struct PredictedVoltage {
    std::vector<double> soc_percent;
    std::vector<double> voltage_v;  ///< terminal
};

/// Predicts a record from its current and resting voltage alone, with a Thévenin battery.
PredictedVoltage predict_voltage(const Battery& battery, const DischargeRecord& record);

/// Identifies the battery without each record in turn and predicts that record. Empty for a single record.
std::vector<LeftOutCheck> leave_each_out(std::span<const DischargeRecord> records,
                                         const IdentificationOptions& options);

}  // namespace flightwatt::battery
