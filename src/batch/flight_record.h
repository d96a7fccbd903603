#pragma once

#include "base/diagnostic.h"
#include "batch/aircraft.h"
#include "flight/flight_identity.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "mechanical/measured_flight.h"
#include "record/record.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt {
Fields<Diagnostic> record_fields(const Diagnostic*);
}

namespace flightwatt::flight {
Fields<PhaseStatistics> record_fields(const PhaseStatistics*);
Fields<CircuitShare> record_fields(const CircuitShare*);
}  // namespace flightwatt::flight

namespace flightwatt::batch {

/// One phase of one sortie.
struct RecordedPhase {
    std::size_t sortie = 1;
    flight::Phase phase = flight::Phase::cruise;
    double start_s = 0.0;
    double end_s = 0.0;
    double start_gap_s = 0.0;  ///< see PhaseEdge
    double end_gap_s = 0.0;
    bool complete = true;
    flight::PhaseStatistics statistics;
};

/// Result of one recording of a log, which is not read again for a fit or a report. The first recording of a log always
/// has one.
struct FlightRecord {
    std::string flight;
    std::string log;          ///< the path it was read from
    std::string fingerprint;  ///< of the log's content, its .log and the options
    std::string results;      ///< fingerprint of the series and phases that were written; empty if rejected
    bool accepted = false;
    std::string error;                    ///< reason of a rejected log
    bool is_of_other_aircraft = false;    ///< rejected as it has no data of --aircraft
    std::vector<std::size_t> recordings;  ///< of the file's first one: numbers of the others with a flight
    std::string aircraft_id;
    std::string aircraft_name;
    std::string kind;  ///< these three: see FlightAircraft
    std::optional<double> pack_voltage_v;
    std::optional<double> cruise_power_w;
    std::optional<double> payload_kg;  ///< that the log states
    std::string power_source;
    std::string current_origin;  ///< see CurrentOrigin
    std::vector<RecordedPhase> phases;
    std::vector<flight::CircuitShare> circuits;  ///< see flight::circuit_shares
    Diagnostics diagnostics;                     ///< without the flight
    std::vector<std::string> power_faults;       ///< see PowerReport
    std::string no_power_reason;                 ///< empty: power was measured
    std::string not_fitted_reason;               ///< see LogFile
    mechanical::MeasuredFlights measured;        ///< of every complete phase
    flight::FlightContent content;               ///< to find duplicates
};

Fields<RecordedPhase> record_fields(const RecordedPhase*);
Fields<FlightRecord> record_fields(const FlightRecord*);

/// The record of a flight that was read and segmented.
FlightRecord record_of(const flight::LoadedFlight& loaded);

FlightAircraft aircraft_of(const FlightRecord& record);

/// Why a log was rejected, without its path.
std::string reason_without_log(const FlightRecord& record);

/// The record as JSON with a seal, the fingerprint of its text, and back; std::nullopt for a record of another version
/// or one that was changed.
std::string to_json_text(const FlightRecord& record);
std::optional<FlightRecord> record_from_json(const std::string& text);

/// Why a batch excludes the flight: its power record, its folder or --exclude; empty if it does not.
std::string exclusion_reason(const FlightRecord& record, const flight::LoadOptions& options);

/// The samples of a flight for a fit, moved out of the record.
mechanical::MeasuredFlights select_for_fit(FlightRecord& record, const flight::LoadOptions& options);

}  // namespace flightwatt::batch
