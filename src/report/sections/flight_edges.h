#pragma once

#include "base/text_table.h"
#include "report/report_flight.h"

#include <string>
#include <vector>

namespace flightwatt::report {

/// Where a phase of a flight begins or ends.
struct NamedEdge {
    double time_s = 0.0;
    std::string name;
    std::string evidence;
    std::string verdict;
};

/// The edges, each once: a phase ends where the next one begins.
std::vector<NamedEdge> edges_of(const ReportFlight& flight);

/// The edges of a flight's phases with what was seen there and what the autopilot says of them, each once.
TextTable edge_table(const ReportFlight& flight);

}  // namespace flightwatt::report
