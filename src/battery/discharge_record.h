#pragma once

#include "battery/battery.h"
#include "flight/flight_data.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::battery {

/// Voltage, current and charge of one pack in a log. All channels are as long as `time_s`.
struct DischargeRecord {
    std::string flight;
    std::vector<double> time_s;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    std::vector<double> mean_current_a;           ///< from the sample before to this one; the first is its current
    std::vector<double> charge_ah;                ///< drawn since the log began
    std::vector<bool> used;                       ///< false: the current is not the battery's load
    double resting_voltage_v = 0.0;               ///< before the first load
    double resting_current_a = 0.0;               ///< of the electronics at that time
    double resolution_v = 0.0;                    ///< minimum difference between two voltages
    std::size_t rest_samples = 0;                 ///< before the first load
    bool is_other_pack = false;                   ///< than the record before it of the same log
    std::optional<int> stated_cells;              ///< in series, by the log
    std::vector<flight::MonitorShare> monitors;   ///< see FlightData
    std::optional<double> air_temperature_c;      ///< mean over the record
    std::optional<double> battery_temperature_c;  ///< likewise
    std::optional<double> battery_start_c;        ///< its temperature at the first load
};

/// The discharges of a log: one, or one a pack where it was changed on the ground.
struct DischargeRecords {
    std::vector<DischargeRecord> records;  ///< NAME, NAME#2, ...
    std::vector<std::string> notes;        ///< changes of the pack, counter resets, records not used
};

/// The records of a log, split where the pack was changed (pack_changes.h). Charge, and mean current where it is fine
/// enough and across gaps, are by the on-board counter, else by the current. The battery rests until the current first
/// exceeds 15 % of its maximum; its resting voltage and current are medians of the last 30 s. Bursts above 1 A at idle
/// throttle are not used. Throws InputError, naming the flight, for a voltage or current that is missing, constant or
/// computed from throttle, and where no record begins at rest.
DischargeRecords discharge_records(const flight::FlightData& data);

std::ptrdiff_t used_sample_count(const DischargeRecord& record);

/// Used samples before the first load.
std::ptrdiff_t rest_sample_count(const DischargeRecord& record);

/// The current [A] of an RC pair's resistor with that time constant at every sample: the solution of tau dx/dt = I - x
/// from the resting current on, exact for a current that is constant between samples.
std::vector<double> rc_branch_current_a(const DischargeRecord& record, double time_constant_s);

/// Returns the heat of the current in one ohm [J] up to each sample.
std::vector<double> heat_a2s(const DischargeRecord& record);

}  // namespace flightwatt::battery
