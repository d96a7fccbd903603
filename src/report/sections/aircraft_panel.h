#pragma once

#include "report/batch_content.h"
#include "report/sections/page_summary.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Returns the HTML of the aircraft: power by phase, energy of the cruise, error of predictions, pack, notes; empty
/// without flights and missions.
std::string aircraft_panel(const PageSummary& answers, std::span<const ReportFlight> flights);

/// Returns the title of a page: "20 Faulty: 3 flights, 3 to 10 July 2020; 9 missions".
std::string page_title(std::span<const ReportFlight> flights, std::size_t missions);

/// Returns the day of a Unix time in UTC: "3 July 2020".
std::string day_text(double clock_s);

/// Returns the title of a flight: "3 July 2020, 10:17", or its name if the date is unknown.
std::string flight_title(const ReportFlight& flight);

/// Returns a line for each aircraft: "20 Faulty: 3 flights, 1 h 6 min in the air, 26.1 Wh", with SYNTHETIC.
std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights);

/// Returns whether any of the accepted flights is synthetic.
bool any_synthetic(std::span<const ReportFlight> flights);

/// Returns a text with the mean error of the energy by leave-one-out of the physical model, which uses the airspeed,
/// and of the model that missions use without it; empty without validation.
std::string prediction_line(const PageSummary& answers, bool synthetic);

}  // namespace flightwatt::report
