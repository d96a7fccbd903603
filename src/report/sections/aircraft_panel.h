#pragma once

#include "report/batch_content.h"
#include "report/sections/page_summary.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Power by phase, energy of the cruise, error of predictions, pack, notes: HTML; empty without flights and missions.
std::string aircraft_panel(const PageSummary& answers, std::span<const ReportFlight> flights);

/// "20 Faulty: 3 flights, 3 to 10 July 2020; 9 missions".
std::string page_title(std::span<const ReportFlight> flights, std::size_t missions);

/// "3 July 2020" (UTC).
std::string day_text(double clock_s);

/// "3 July 2020, 10:17", or the flight's name where its date is unknown.
std::string flight_title(const ReportFlight& flight);

/// "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh" of each aircraft, with SYNTHETIC.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Whether any of the accepted flights is synthetic.
bool any_synthetic(std::span<const ReportFlight> flights);

/// Mean error of the energy by leave-one-out: of the physical model, which knows the airspeed, and of the model that
/// missions use without it; empty without validation.
std::string prediction_line(const PageSummary& answers, bool synthetic);

}  // namespace flightwatt::report
