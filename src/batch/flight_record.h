#pragma once

#include "flight/flight_identity.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "mechanical/measured_flight.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::batch {

/// One phase of one sortie as the batch remembers it.
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

/// What the autopilot says of an edge of a phase.
struct RecordedEdgeCheck {
    double time_s = 0.0;  ///< of the edge
    std::string text;     ///< "agrees with TAKEOFF (-0.4 s)", "no witness"
};

/// What became of one log: enough to go on without reading it again.
struct FlightRecord {
    std::string flight;
    std::string log;          ///< the path it was read from
    std::string fingerprint;  ///< of the log's content, its .log and the options
    std::string results;      ///< fingerprint of the series and phases that were written; empty if rejected
    bool accepted = false;
    std::string error;                  ///< why it was rejected
    bool is_of_other_aircraft = false;  ///< rejected for that alone: it was not asked for
    std::string aircraft_id;
    std::string aircraft_name;
    std::string power_source;
    std::string current_origin;  ///< see CurrentOrigin
    std::vector<RecordedPhase> phases;
    std::vector<RecordedEdgeCheck> verdicts;  ///< of the edges that the log shows
    std::vector<std::string> warnings;
    std::vector<std::string> power_faults;  ///< of its power record: see PowerReport
    std::string no_power_reason;            ///< why no power was measured; empty if it was
    std::string not_fitted_reason;          ///< what its folder says: see LogFile
    mechanical::MeasuredFlights measured;   ///< of every complete phase, however few its samples
    flight::FlightContent content;          ///< to find it under another name
};

/// The record of a flight that was read and segmented.
FlightRecord record_of(const flight::LoadedFlight& loaded);

/// The record as JSON with a seal, the fingerprint of its text, and back. Reading gives std::nullopt for what
/// is no record of this version, or was changed since.
std::string to_json_text(const FlightRecord& record);
std::optional<FlightRecord> record_from_json(const std::string& text);

/// Why a batch uses nothing of the flight: its power record, its folder or --exclude; empty if it does.
std::string exclusion_reason(const FlightRecord& record, const flight::LoadOptions& options);

/// What a fit of a batch takes of a flight. Takes the samples out of the record: of thousands of flights they
/// are kept until the fit, once.
mechanical::MeasuredFlights select_for_fit(FlightRecord& record, std::size_t needed_samples,
                                           const flight::LoadOptions& options);

}  // namespace flightwatt::batch
