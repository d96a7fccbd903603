#pragma once

#include "report/batch_content.h"
#include "report/document/findings.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Returns the mean power by phase, facts, and flights with warnings (AircraftPanel of web/app/src/documents.ts); null
/// without flights and missions.
Json aircraft_panel(const Findings& findings, std::span<const ReportFlight> flights);

/// Returns the title of a page: "20 Faulty: 3 flights, 3 to 10 July 2020; 9 missions".
std::string page_title(std::span<const ReportFlight> flights, std::size_t missions);

/// Returns the title of a flight: "3 July 2020, 10:17", or its name if the date is unknown.
std::string flight_title(const ReportFlight& flight);

/// An aircraft with its flights.
struct AircraftLine {
    std::string name;  ///< "20 Faulty", with SYNTHETIC
    std::string text;  ///< "3 flights \u00b7 1 h 6 min in the air \u00b7 26.1 Wh"
};
Fields<AircraftLine> record_fields(const AircraftLine*);

/// Returns a line for each aircraft.
std::vector<AircraftLine> aircraft_lines(std::span<const ReportFlight> flights);

/// Returns whether any of the accepted flights is synthetic.
bool any_synthetic(std::span<const ReportFlight> flights);

/// Returns a text with the mean error of the energy by leave-one-out of the physical model, which uses the airspeed,
/// and of the model that missions use without it; empty without validation.
std::string prediction_line(const Findings& findings, bool synthetic);

}  // namespace flightwatt::report
