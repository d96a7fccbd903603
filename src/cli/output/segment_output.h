#pragma once

#include "base/diagnostic.h"
#include "cli/screen_table.h"
#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/power_report.h"

#include <string>
#include <vector>

/// Output of segment.
namespace flightwatt::cli {

/// Title of a flight's tables: its name, aircraft and number of sorties.
std::string describe_flight(const flight::FlightData& data, const flight::FlightPhases& phases);

/// A row an edge that the log has: time, altitude, throttle, and mode, block and TAKEOFF message of the autopilot.
TextTable edges_table(const flight::FlightData& data, const flight::FlightPhases& phases);

/// Output of `segment --explain`: edges, rejected activities and findings on the power record.
std::string explanation(const flight::FlightData& data, const flight::FlightPhases& phases,
                        const flight::PowerReport& power, const Screen& screen);

/// A flight of the JSON.
struct SegmentedFlight {
    const flight::FlightData* data = nullptr;
    const flight::FlightPhases* phases = nullptr;
    const flight::PowerReport* power = nullptr;
    const Diagnostics* diagnostics = nullptr;
};
Fields<SegmentedFlight> record_fields(const SegmentedFlight*);

/// JSON of the stage.
struct SegmentOutput {
    std::vector<Json> flights;  ///< of SegmentedFlight, as their data are not kept
};
Fields<SegmentOutput> record_fields(const SegmentOutput*);

}  // namespace flightwatt::cli
